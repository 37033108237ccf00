//! Passes on what `embree-sys` found: the version, for the program to print, and the place of a library that the
//! loader does not know, as the run path of the binaries. And links the shim of OpenImageIO to a shared object, which the
//! binary carries and loads when a picture needs it: linking OpenImageIO itself was measured at 220 ms and 131 MB a start.

#[cfg(feature = "oiio")]
mod oiio {
    use std::env;
    use std::path::PathBuf;
    use std::process::Command;

    const SHIM: &str = "src/picture/oiio_shim.cpp";
    const ADVICE: &str = "install it (Debian: apt-get install libopenimageio-dev pkg-config), or build without it: \
                          --no-default-features --features embree";

    /// Builds the shim; what is missing otherwise.
    pub(crate) fn build() -> Result<(), String> {
        println!("cargo::rerun-if-changed={SHIM}");
        // Version 2.3 made pointers to inputs and outputs own them.
        let library = pkg_config::Config::new()
            .cargo_metadata(false)
            .atleast_version("2.3")
            .probe("OpenImageIO")
            .map_err(|error| format!("OpenImageIO 2.3 or newer was not found: {ADVICE}\n{error}"))?;
        let target = PathBuf::from(env::var("OUT_DIR").unwrap_or_default()).join("oiio_shim.so");
        let compiler =
            cc::Build::new().cpp(true).std("c++17").opt_level(2).pic(true).debug(false).get_compiler();
        let mut command = compiler.to_command();
        command.args(["-Wall", "-Wextra", "-shared", "-s", SHIM, "-o"]).arg(&target);
        command.args(library.include_paths.iter().map(|path| format!("-I{}", path.display())));
        for path in &library.link_paths {
            command.args([format!("-L{}", path.display()), format!("-Wl,-rpath,{}", path.display())]);
        }
        command.args(library.libs.iter().map(|name| format!("-l{name}")));
        run(&mut command)
    }

    fn run(command: &mut Command) -> Result<(), String> {
        match command.output() {
            Ok(output) if output.status.success() => Ok(()),
            Ok(output) => {
                let reason = String::from_utf8_lossy(&output.stderr).into_owned();
                Err(format!("the shim of OpenImageIO can't be built: {ADVICE}\n{reason}"))
            }
            Err(error) => Err(format!(
                "no C++ compiler for the shim of OpenImageIO: {error}\n{ADVICE}, build-essential"
            )),
        }
    }
}

use std::env;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let version = env::var("DEP_EMBREE_VERSION").unwrap_or_else(|_| "none".to_string());
    println!("cargo::rustc-env=PATHTRACER_EMBREE_VERSION={version}");
    if let Ok(folder) = env::var("DEP_EMBREE_RPATH") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{folder}");
    }
    #[cfg(feature = "oiio")]
    if let Err(message) = oiio::build() {
        message.lines().for_each(|line| println!("cargo::error={line}"));
    }
}
