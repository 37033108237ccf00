//! `pathtracer farm`: what is printed. `tests/farm` runs it on the real engines.

use super::Folder;

const FARM: &str = "--parts 3 ball.yaml 40 36 20 4 out.exr --seed 2";

#[test]
fn the_template_has_a_task_a_part_and_a_merge() {
    let folder = Folder::new();
    let ended = folder.run(&format!("farm export {FARM} --exposure 1"));
    ended.succeeds();
    for part in [
        "specificationVersion: jobtemplate-2023-09",
        "range: \"0-2\"",
        "\"--part\", \"{{Task.Param.Part}}/3\"",
        "\"--seed\", \"2\"",
        "\"merge\", \"{{Param.Folder}}/part-0.film\"",
        "\"--exposure\", \"1\"",
    ] {
        assert!(ended.stdout.contains(part), "{part}: {}", ended.stdout);
    }
}

#[test]
fn the_script_has_an_array_and_a_dependent_merge() {
    let folder = Folder::new();
    let ended = folder.run(&format!("farm slurm {FARM}"));
    ended.succeeds();
    for part in ["--array=0-2", "--requeue", "--dependency=\"afterok:$parts\"", "out.exr.parts/part-2.film"] {
        assert!(ended.stdout.contains(part), "{part}: {}", ended.stdout);
    }
}

#[test]
fn tasks_have_the_options_that_only_change_what_they_cost() {
    let folder = Folder::new();
    let options = "--accel native --bvh quality --isa sse2 --tile 8 --threads 2 --every 5m";
    let passed = [
        "--accel native",
        "--bvh quality",
        "--isa sse2",
        "--tile 8",
        "--threads 2",
        "--every 300",
        "--cpus-per-task=2",
    ];
    for precision in ["exact", "fast"] {
        let ended = folder.run(&format!("farm slurm {FARM} {options} --precision {precision}"));
        ended.succeeds();
        for option in passed {
            // Without Embree that is no choice; but at fast it is part of what is rendered.
            let is_choice = cfg!(feature = "embree") || precision == "fast";
            let times = usize::from(is_choice || option != "--accel native");
            assert_eq!(ended.stdout.matches(option).count(), times, "{option}: {}", ended.stdout);
        }
    }
    let ended = folder.run(&format!("farm export {FARM} --accel native"));
    let is_told = ended.stdout.contains("\"--accel\", \"native\"");
    assert_eq!(is_told, cfg!(feature = "embree"), "{}", ended.stdout);
}

#[test]
fn options_that_a_farm_cannot_keep_are_refused() {
    let folder = Folder::new();
    for (option, why) in [
        ("--stamp", "leave out --stamp"),
        ("--checkpoint a.film", "every part keeps its own checkpoint"),
        ("--resume a.film", "every part keeps its own checkpoint"),
        ("--json", "leave out --json"),
        ("--progress=openjd", "leave out --json and --progress"),
        ("--time 5", "farm cuts the picture itself"),
    ] {
        for engine in ["export", "slurm"] {
            folder.run(&format!("farm {engine} {FARM} {option}")).fails(2, why);
        }
    }
}

#[test]
fn jobs_that_cannot_be_are_refused() {
    let folder = Folder::new();
    folder.run("farm export --parts 3 missing.yaml 40 36 20 4 out.exr").fails(3, "missing.yaml");
    folder
        .run("farm export --parts 1000 ball.yaml 40 36 20 4 out.exr")
        .fails(2, "make as many parts at most");
    folder.run(&format!("farm slurm {FARM} --part 0/2")).fails(2, "farm cuts the picture itself");
    folder.run("farm slurm ball.yaml 40 36 20 4 out.exr").fails(2, "--parts");
}

#[test]
fn progress_is_printed_as_open_job_description_has_it() {
    let folder = Folder::new();
    for option in ["--progress openjd", "--progress=openjd"] {
        let ended = folder.run(&format!("missing.yaml 8 6 1 3 a.png {option}"));
        ended.fails(3, "missing.yaml");
        assert!(ended.stdout.starts_with("openjd_fail: "), "{}", ended.stdout);
    }
    let ended = folder.run("ball.yaml 256 256 60 4 a.png --progress openjd -q");
    ended.succeeds();
    assert!(ended.stdout.lines().all(|line| line.starts_with("openjd_")), "{}", ended.stdout);
}
