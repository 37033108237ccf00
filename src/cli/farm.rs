//! `pathtracer farm`: a render in parts as a job of an engine that exists.

use super::arguments::{EVERY, FarmArguments, FarmCommand, Job};
use super::saving;
use crate::error::{Error, Result};
use crate::film::Region;
use crate::output::{shell, shell_line};
use crate::picture::Destination;
use crate::render::{Recipe, Settings, in_pool};
use crate::scene;
use std::io::{self, Write};
use std::path::Path;

/// Prints the job; returns the exit code.
pub(super) fn run(command: FarmCommand) -> anyhow::Result<u8> {
    let text = match command {
        FarmCommand::Export(arguments) => template(&Farm::new(*arguments)?),
        FarmCommand::Slurm(arguments) => script(&Farm::new(*arguments)?)?,
    };
    io::stdout().lock().write_all(text.as_bytes())?;
    Ok(0)
}

/// A render in parts.
struct Farm {
    job: Job,
    recipe: Recipe,
    parts: u32,
    folder: String,
}

impl Farm {
    /// Whatever can be known to fail fails here, not on the farm.
    fn new(arguments: FarmArguments) -> anyhow::Result<Farm> {
        let (job, parts, folder) = arguments.resolve()?;
        if let Some(why) = refused(&job) {
            return Err(Error::Usage(why.into()).into());
        }
        job.settings.check()?;
        let region = Region::Part { index: 0, count: parts };
        Settings { region, ..job.settings.clone() }.check()?;
        Destination::new(&job.image)?;
        let scene = in_pool(&job.settings, || scene::load(&job.scene))?;
        let recipe = Recipe::new(&job.scene, scene.digest, &job.settings)?;
        Ok(Farm { job, recipe, parts, folder: folder.to_string_lossy().into_owned() })
    }

    /// The arguments of a task, after the program: the scene, the file and the number of the part are given.
    fn task(&self, scene: &str, file: &str, part: &str) -> Vec<String> {
        let mut words = self.recipe.arguments(file);
        scene.clone_into(&mut words[0]);
        words.extend(["--part".into(), format!("{part}/{}", self.parts)]);
        for (option, value) in self.task_options() {
            if !words.contains(&option) {
                words.extend([option, value]);
            }
        }
        words
    }

    /// The options that do not change the sums of a task, but what they cost.
    fn task_options(&self) -> impl Iterator<Item = (String, String)> {
        let Job { settings, every, .. } = &self.job;
        let defaults = Settings::new(1, 1, 1, 1);
        let all = [
            ("--accel", (settings.accel != defaults.accel).then(|| settings.accel.name().to_owned())),
            ("--isa", settings.isa.map(|isa| isa.name().to_owned())),
            ("--bvh", (settings.bvh != defaults.bvh).then(|| settings.bvh.name().to_owned())),
            ("--threads", settings.threads.map(|threads| threads.to_string())),
            ("--tile", settings.tile.map(|side| side.to_string())),
            ("--every", (*every != EVERY).then(|| every.as_secs_f64().to_string())),
        ];
        all.into_iter().filter_map(|(option, value)| Some((option.to_owned(), value?)))
    }

    /// The arguments of the last task.
    fn merge(&self, folder: &str, image: &str) -> Vec<String> {
        let mut words = vec!["merge".to_owned()];
        words.extend((0..self.parts).map(|part| format!("{folder}/part-{part}.film")));
        words.push(image.to_owned());
        words.extend(picture_options(&self.job));
        words.extend(self.job.quiet.then(|| "--quiet".to_owned()));
        words
    }
}

/// What a render may have that a farm's can't, and why.
fn refused(job: &Job) -> Option<&'static str> {
    let all = [
        (
            saving::is_part(job) || job.settings.time.is_some(),
            "farm cuts the picture itself: leave out --part, --crop, --chunks and --time",
        ),
        (
            job.checkpoint.is_some() || job.resume.is_some(),
            "every part keeps its own checkpoint and goes on with it: leave out --checkpoint and --resume",
        ),
        (job.stamp, "a picture of many machines has no one time and machine: leave out --stamp"),
        (
            job.json || job.openjd,
            "farm prints a job, not how a render goes on: leave out --json and --progress, or add them to the job's commands",
        ),
    ];
    all.into_iter().find_map(|(is_given, why)| is_given.then_some(why))
}

/// The options of a render that only say how its picture is written.
pub(super) fn picture_options(job: &Job) -> Vec<String> {
    let bars = job.error_bars.as_ref().map(|path| path.to_string_lossy().into_owned());
    let bars = bars.into_iter().flat_map(|path| ["--error-bars".to_owned(), path]);
    job.wanted().options().into_iter().chain(bars).collect()
}

/// The template of Open Job Description.
fn template(farm: &Farm) -> String {
    let Farm { job, parts, folder, .. } = farm;
    let list = |words: Vec<String>| words.iter().map(|word| quoted(word)).collect::<Vec<_>>().join(", ");
    let file = "{{Param.Folder}}/part-{{Task.Param.Part}}.film";
    let mut task = farm.task("{{Param.Scene}}", file, "{{Task.Param.Part}}");
    task.extend(["--progress".into(), "openjd".into()]);
    let merge = farm.merge("{{Param.Folder}}", "{{Param.Image}}");
    let name = job.scene.file_stem().unwrap_or_default().to_string_lossy().replace(['{', '}'], "_");
    format!(
        "specificationVersion: jobtemplate-2023-09
name: {name}
parameterDefinitions:
  - {{name: Program, type: STRING, default: pathtracer}}
  - {{name: Scene, type: PATH, objectType: FILE, dataFlow: IN, default: {scene}}}
  - {{name: Image, type: PATH, objectType: FILE, dataFlow: OUT, default: {image}}}
  - {{name: Folder, type: PATH, objectType: DIRECTORY, dataFlow: INOUT, default: {folder}}}
steps:
  - name: Parts
    parameterSpace:
      taskParameterDefinitions: [{{name: Part, type: INT, range: \"0-{last}\"}}]
    script:
      actions:
        onRun:
          command: \"{{{{Param.Program}}}}\"
          args: [{task}]
          cancelation: {{mode: NOTIFY_THEN_TERMINATE, notifyPeriodInSeconds: 60}}
  - name: Merge
    dependencies: [{{dependsOn: Parts}}]
    script:
      actions:
        onRun:
          command: \"{{{{Param.Program}}}}\"
          args: [{merge}]
",
        name = quoted(&format!("pathtracer {name}")),
        scene = quoted(&job.scene.to_string_lossy()),
        image = quoted(&job.image.to_string_lossy()),
        folder = quoted(folder),
        last = parts - 1,
        task = list(task),
        merge = list(merge),
    )
}

/// A string as JSON has it, which YAML reads too.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

/// A shell script with the two calls of sbatch.
fn script(farm: &Farm) -> Result<String> {
    let program = std::env::current_exe().map_err(|source| Error::Io {
        action: "find".into(),
        path: Path::new("pathtracer").into(),
        source,
    })?;
    let program = shell(&program.to_string_lossy());
    let scene = farm.job.scene.to_string_lossy();
    // The array's index stays a variable of the task's shell. The braces see to it that its words are quoted.
    let index = "{SLURM_ARRAY_TASK_ID}";
    let file = format!("{}/part-{index}.film", farm.folder);
    let mut task = shell_line(farm.task(&scene, &file, index));
    task = task.replace(index, "'\"$SLURM_ARRAY_TASK_ID\"'");
    let merge = shell_line(farm.merge(&farm.folder, &farm.job.image.to_string_lossy()));
    let threads =
        farm.job.settings.threads.map(|threads| format!(" --cpus-per-task={threads}")).unwrap_or_default();
    Ok(format!(
        "#!/bin/sh
# {parts} parts and the merge, for Slurm. A part whose node fails, or whose place another job takes, is requeued and goes on
# from its last checkpoint. One that dies otherwise fails, and the merge is cancelled; to run this again makes only what is
# missing.
set -e
parts=$(sbatch --parsable --job-name=pathtracer --array=0-{last} --requeue --signal=B:TERM@60{threads} <<'EOF'
#!/bin/sh
exec {program} {task} --quiet
EOF
)
sbatch --job-name=pathtracer-merge --dependency=\"afterok:$parts\" --kill-on-invalid-dep=yes <<'EOF'
#!/bin/sh
exec {program} {merge}
EOF
",
        parts = farm.parts,
        last = farm.parts - 1,
    ))
}
