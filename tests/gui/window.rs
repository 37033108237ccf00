//! The real window on a virtual display, driven by mouse and keys. Where they are is asked of the same widgets without a
//! display.

use super::Desk;
use super::panels::{Window, window};
use eframe::egui::Pos2;
use eframe::egui::accesskit::Role;
use egui_kittest::kittest::Queryable;
use serde_json::json;
use std::env;
use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

/// How long is waited for anything.
const PATIENCE: Duration = Duration::from_secs(180);
/// How long is waited for the effect of keys before they are pressed once more.
const TRY: Duration = Duration::from_secs(3);
/// How often is looked.
const LOOK: Duration = Duration::from_millis(20);

/// Waits for something that another process does.
#[track_caller]
fn wait_for<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(start.elapsed() < PATIENCE, "waited in vain for {what}");
        thread::sleep(LOOK);
    }
}

/// Set by those who run the tests on a machine that has no virtual display, and accept it.
const WITHOUT_DISPLAY: &str = "PATHTRACER_TEST_WITHOUT_XVFB";

/// Whether a real window can be opened.
///
/// # Panics
/// A tool is missing, and nobody said that this may be.
fn has_tools() -> bool {
    for tool in ["Xvfb", "xdotool"] {
        if Command::new("which").arg(tool).output().is_ok_and(|output| output.status.success()) {
            continue;
        }
        let missing = format!("this machine has no {tool} (Debian: xvfb, xdotool, libgl1-mesa-dri)");
        assert!(
            env::var_os(WITHOUT_DISPLAY).is_some(),
            "{missing}; {WITHOUT_DISPLAY}=1 leaves this test out"
        );
        println!("skipped: {missing}");
        return false;
    }
    true
}

/// A virtual display with the program's window on it.
struct Screen {
    server: Child,
    program: Child,
    display: String,
    window: String,
}

impl Screen {
    /// Opens the window on a scene; `None` where that is to be left out.
    fn open(desk: &Desk, arguments: &[&str], samples: u64) -> Option<Screen> {
        if !has_tools() {
            return None;
        }
        let mut server = Command::new("Xvfb")
            // Without -noreset the server starts anew when xdotool, its only client then, ends: a window that
            // is opened at this moment is lost.
            .args(["-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp", "-noreset"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("Xvfb starts");
        let mut number = String::new();
        BufReader::new(server.stdout.take().expect("a pipe"))
            .read_line(&mut number)
            .expect("a display's number");
        let display = format!(":{}", number.trim());
        let kept = json!({
            "width": 160, "height": 90, "samples": samples, "bounces": 8, "accelerator": "native",
            "window": [1280, 800],
        });
        fs::create_dir_all(desk.path("config/pathtracer")).expect("a folder");
        desk.write("config/pathtracer/window.json", &kept.to_string());
        let program = Command::new(env!("CARGO_BIN_EXE_pathtracer"))
            .args(arguments)
            .current_dir(desk.folder.path())
            .env("DISPLAY", &display)
            .env_remove("WAYLAND_DISPLAY")
            .env("XDG_CONFIG_HOME", desk.path("config"))
            .env("LIBGL_ALWAYS_SOFTWARE", "1")
            .spawn()
            .expect("the program starts");
        let mut screen = Screen { server, program, display, window: String::new() };
        screen.window = wait_for("the window", || {
            assert!(screen.program.try_wait().expect("a child").is_none(), "no window was opened");
            let found = screen.tell(&["search", "--onlyvisible", "--name", "balls.yaml"]);
            found.lines().next().map(str::to_owned)
        });
        screen.tell(&["windowfocus", "--sync", &screen.window.clone()]);
        Some(screen)
    }

    /// Runs xdotool; what it says.
    fn tell(&self, arguments: &[&str]) -> String {
        let output = Command::new("xdotool").args(arguments).env("DISPLAY", &self.display).output();
        String::from_utf8(output.expect("xdotool starts").stdout).expect("UTF-8")
    }

    fn key(&self, key: &str) {
        self.tell(&["key", "--clearmodifiers", key]);
    }

    /// Without --sync, which waits long for a mouse that is there already.
    fn click(&self, at: Pos2) {
        let [x, y] = [at.x, at.y].map(|place| place.round().to_string());
        self.tell(&["mousemove", &x, &y, "click", "1"]);
    }

    fn title(&self) -> String {
        self.tell(&["getwindowname", &self.window])
    }

    /// Does something until it has had its effect: where frames are slow, keys may arrive before what they are for.
    #[track_caller]
    fn insist(&self, what: &str, act: impl Fn(), holds: impl Fn() -> bool) {
        wait_for(what, || {
            act();
            let start = Instant::now();
            while start.elapsed() < TRY {
                if holds() {
                    return Some(());
                }
                thread::sleep(LOOK);
            }
            None
        });
    }

    /// Starts the final render, and waits until there is a picture of it.
    #[track_caller]
    fn start_render(&self) {
        self.insist("a picture", || self.key("Return"), || self.title().contains('%'));
    }

    /// Asks the window to close.
    fn ask_to_close(&self) {
        self.key("ctrl+q");
    }

    /// Closes the window; how the program ended.
    fn close(&mut self) -> ExitStatus {
        self.ask_to_close();
        wait_for("the end of the program", || self.program.try_wait().expect("a child"))
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // What has ended already can't be ended.
        let _ = self.program.kill();
        let _ = self.program.wait();
        let _ = self.server.kill();
        let _ = self.server.wait();
    }
}

fn field(window: &Window<'_>, label: &str) -> Pos2 {
    window.get_by_role_and_label(Role::TextInput, label).rect().center()
}

#[test]
fn a_scene_is_changed_focused_rendered_and_saved_as_by_the_command_line() {
    let desk = Desk::new();
    let Some(mut screen) = Screen::open(&desk, &["gui", "balls.yaml"], 16) else { return };
    let widgets = window(&desk);
    let text = || String::from_utf8(desk.read("balls.yaml")).expect("UTF-8");
    let type_60 = || {
        screen.click(field(&widgets, "Field of view (°)"));
        screen.key("ctrl+a");
        screen.tell(&["type", "60"]);
        screen.tell(&["key", "Escape", "ctrl+s"]);
    };
    screen.insist("another field of view", type_60, || text().contains("Fov: 0.3333333333333333\n"));
    let middle = widgets.state().1.canvas.place.expect("a place").center();
    let focus = || {
        screen.key("f");
        screen.click(middle);
        screen.key("ctrl+s");
    };
    screen.insist("another focus", focus, || !text().contains("FocusDistance: 6 "));
    // The middle of the picture shows the ball, which is nearer than its centre by its radius.
    let text = text();
    let focus = text.lines().find(|line| line.contains("FocusDistance:")).expect("a focus distance");
    assert!(focus.starts_with("  FocusDistance: 5.08") && focus.ends_with("# the ball"), "{focus}");
    let exists = || fs::exists(desk.path("balls.png")).expect("a folder");
    screen.insist("the picture", || screen.key("Return"), exists);
    assert_eq!(screen.close().code(), Some(0));
    let arguments = "balls.yaml 160 90 16 8 line.png --accel native";
    desk.command(&arguments.split(' ').collect::<Vec<_>>());
    assert!(desk.read("balls.png") == desk.read("line.png"));
    let kept = String::from_utf8(desk.read("config/pathtracer/window.json")).expect("UTF-8");
    assert!(kept.contains("balls.yaml"), "{kept}");
}

/// Checks that a picture is that of the command line with as many samples as it says.
fn check_picture(desk: &Desk, name: &str) {
    let info = desk.command(&["info", name]);
    let info = String::from_utf8(info.stdout).expect("UTF-8");
    let written = info.lines().find(|line| line.contains("samplesPerPixel")).expect("a number of samples");
    let samples = written.rsplit(' ').next().expect("a number");
    desk.command(&["balls.yaml", "160", "90", samples, "8", "line.png", "--accel", "native"]);
    assert!(desk.read(name) == desk.read("line.png"), "{samples} samples");
}

#[test]
fn closing_the_window_during_a_render_writes_its_picture_and_leaves_no_process() {
    let desk = Desk::new();
    let Some(mut screen) = Screen::open(&desk, &["balls.yaml"], 1 << 30) else { return };
    screen.start_render();
    assert_eq!(screen.close().code(), Some(0));
    check_picture(&desk, "balls.png");
}

#[test]
fn a_window_whose_picture_cannot_be_written_stays_open_once_and_keeps_the_film() {
    let desk = Desk::new();
    let Some(mut screen) = Screen::open(&desk, &["balls.yaml"], 1 << 30) else { return };
    screen.start_render();
    fs::create_dir(desk.path("balls.png")).expect("a folder");
    screen.ask_to_close();
    wait_for("the end of the render", || (!screen.title().contains('%')).then_some(()));
    assert!(screen.program.try_wait().expect("a child").is_none(), "the window was closed");
    assert_eq!(screen.close().code(), Some(0));
    desk.command(&["merge", "balls.png.film", "merged.png"]);
    check_picture(&desk, "merged.png");
}
