//! Finds Embree, says which of 3 and 4 it is, and makes the bindings from its headers.
//!
//! Searched in this order: `EMBREE_DIR` (`include/` and `lib/` below it), pkg-config, the standard folders.
//! Debian ships no `.pc` file for Embree, so the last is the usual case. Where both are found, 4 is taken.

use std::env;
use std::fs;
use std::panic::{self, AssertUnwindSafe};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Major versions this crate binds, the preferred one first.
const MAJORS: [u32; 2] = [4, 3];

/// Names that packagers give the `.pc` file, the preferred one first.
const PKG_CONFIG_NAMES: [&str; 3] = ["embree4", "embree3", "embree"];

/// The functions that `src/lib.rs` offers.
const FUNCTIONS: [&str; 29] = [
    "rtcNewDevice",
    "rtcReleaseDevice",
    "rtcGetDeviceError",
    "rtcGetDeviceProperty",
    "rtcSetDeviceErrorFunction",
    "rtcSetDeviceMemoryMonitorFunction",
    "rtcNewScene",
    "rtcReleaseScene",
    "rtcSetSceneFlags",
    "rtcSetSceneBuildQuality",
    "rtcCommitScene",
    "rtcGetSceneBounds",
    "rtcAttachGeometry",
    "rtcAttachGeometryByID",
    "rtcNewGeometry",
    "rtcReleaseGeometry",
    "rtcCommitGeometry",
    "rtcSetGeometryMask",
    "rtcSetGeometryBuildQuality",
    "rtcSetGeometryUserData",
    "rtcSetGeometryUserPrimitiveCount",
    "rtcSetGeometryBoundsFunction",
    "rtcSetGeometryIntersectFunction",
    "rtcSetGeometryOccludedFunction",
    "rtcSetGeometryIntersectFilterFunction",
    "rtcSetGeometryOccludedFilterFunction",
    "rtcSetSharedGeometryBuffer",
    "rtcIntersect1",
    "rtcOccluded1",
];

/// The macros that are used; enumerations come with the functions.
const CONSTANTS: &str = "RTC_VERSION_(MAJOR|MINOR|PATCH)|RTC_MAX_INSTANCE_LEVEL_COUNT";

/// An installed Embree.
struct Embree {
    major: u32,
    /// The folder that holds `embree3/` or `embree4/`.
    include: PathBuf,
    /// The folder of the library.
    lib: PathBuf,
    /// As the header spells it, such as "3.13.5".
    version: String,
}

fn main() -> ExitCode {
    println!("cargo::rustc-check-cfg=cfg(embree3)");
    println!("cargo::rustc-check-cfg=cfg(embree4)");
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=EMBREE_DIR");
    match find().and_then(|embree| bind(&embree).map(|()| embree)) {
        Ok(embree) => {
            link(&embree);
            ExitCode::SUCCESS
        }
        Err(message) => {
            for line in message.lines() {
                println!("cargo::error={line}");
            }
            ExitCode::FAILURE
        }
    }
}

/// The Embree to build against, or what to do about its absence.
fn find() -> Result<Embree, String> {
    if let Some(dir) = env::var_os("EMBREE_DIR").filter(|dir| !dir.is_empty()) {
        return in_embree_dir(Path::new(&dir));
    }
    let includes = [PathBuf::from("/usr/include"), PathBuf::from("/usr/local/include")];
    let libs = library_folders(Path::new("/usr")).chain(library_folders(Path::new("/usr/local")));
    by_pkg_config().or_else(|| search(&includes, &libs.collect::<Vec<_>>())).ok_or_else(|| {
        "Embree was not found.\n\
         Install it:               apt install libembree-dev\n\
         or say where it is:       EMBREE_DIR=/path (with include/embree3 or include/embree4, and lib/)\n\
         or build without it:      cargo build --no-default-features (switches the feature `embree` off)"
            .to_string()
    })
}

/// Embree below the folder that the user named; never any other.
fn in_embree_dir(dir: &Path) -> Result<Embree, String> {
    let include = dir.join("include");
    let libs: Vec<_> = library_folders(dir).collect();
    search(std::slice::from_ref(&include), &libs).ok_or_else(|| {
        format!(
            "EMBREE_DIR={} does not hold Embree: wanted are include/embree4/rtcore.h and libembree4.so, or \
             include/embree3/rtcore.h and libembree3.so, the library in one of lib, lib64, {}.\n\
             Without EMBREE_DIR the package libembree-dev is used (apt install libembree-dev).\n\
             To build without Embree: cargo build --no-default-features (switches the feature `embree` off)",
            dir.display(),
            multiarch_folder().display(),
        )
    })
}

/// What pkg-config says; its folders first, then the standard ones, which it leaves out.
fn by_pkg_config() -> Option<Embree> {
    PKG_CONFIG_NAMES.iter().find_map(|name| {
        let found = pkg_config::Config::new().cargo_metadata(false).env_metadata(true).probe(name).ok()?;
        let includes: Vec<_> = found.include_paths.into_iter().chain(["/usr/include".into()]).collect();
        let libs: Vec<_> = found.link_paths.into_iter().chain(library_folders(Path::new("/usr"))).collect();
        search(&includes, &libs)
    })
}

/// The first version whose header and library are both there.
fn search(includes: &[PathBuf], libs: &[PathBuf]) -> Option<Embree> {
    MAJORS.iter().find_map(|&major| {
        let include = includes.iter().find(|dir| dir.join(format!("embree{major}/rtcore.h")).is_file())?;
        let lib = libs.iter().find(|dir| holds_library(dir, major))?;
        let version = header_version(&include.join(format!("embree{major}/rtcore_config.h")))?;
        let fits = version.split('.').next() == Some(major.to_string().as_str());
        fits.then(|| Embree { major, include: include.clone(), lib: lib.clone(), version })
    })
}

/// Where the libraries of an installation below `prefix` may be.
fn library_folders(prefix: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    [PathBuf::from("lib"), PathBuf::from("lib64"), multiarch_folder()].map(|dir| prefix.join(dir)).into_iter()
}

/// Debian's folder for the libraries of the machine built for, such as `lib/x86_64-linux-gnu`.
fn multiarch_folder() -> PathBuf {
    let machine = env::var("CARGO_CFG_TARGET_ARCH").unwrap_or_default();
    PathBuf::from(format!("lib/{machine}-linux-gnu"))
}

fn holds_library(dir: &Path, major: u32) -> bool {
    ["so", "dylib"].iter().any(|ext| dir.join(format!("libembree{major}.{ext}")).is_file())
}

/// The value of `RTC_VERSION_STRING`.
fn header_version(config: &Path) -> Option<String> {
    let text = fs::read_to_string(config).ok()?;
    let line = text.lines().find(|line| line.starts_with("#define RTC_VERSION_STRING"))?;
    line.split('"').nth(1).map(str::to_string)
}

/// Writes `bindings.rs`, with layout tests, from the headers of `embree`.
fn bind(embree: &Embree) -> Result<(), String> {
    let mut builder = bindgen::Builder::default()
        .header_contents("embree.h", &format!("#include <embree{}/rtcore.h>", embree.major))
        .clang_arg(format!("-I{}", embree.include.display()))
        .allowlist_var(CONSTANTS)
        .allowlist_type("RTC(RayHit|Bounds|IntersectContext|RayQueryContext)")
        .prepend_enum_name(false)
        .derive_default(true)
        .layout_tests(true)
        .formatter(bindgen::Formatter::None)
        .parse_callbacks(Box::new(bindgen::CargoCallbacks::new()));
    for function in FUNCTIONS {
        builder = builder.allowlist_function(function);
    }
    let output = PathBuf::from(env::var_os("OUT_DIR").ok_or("OUT_DIR is not set")?).join("bindings.rs");
    let bindings = generate(builder)?;
    bindings.write_to_file(&output).map_err(|e| format!("cannot write {}: {e}", output.display()))
}

/// Runs bindgen, which panics where it can't load libclang.
fn generate(builder: bindgen::Builder) -> Result<bindgen::Bindings, String> {
    const CLANG: &str = "The bindings to Embree are made with libclang: apt install libclang-dev\n\
                         (or build without Embree: cargo build --no-default-features)";
    let hook = panic::take_hook();
    panic::set_hook(Box::new(|_| ()));
    let result = panic::catch_unwind(AssertUnwindSafe(|| builder.generate()));
    panic::set_hook(hook);
    match result {
        Ok(Ok(bindings)) => Ok(bindings),
        Ok(Err(error)) => Err(format!("the headers of Embree could not be read: {error}\n{CLANG}")),
        Err(panic) => {
            let reason = panic.downcast_ref::<String>().map_or("bindgen failed", String::as_str);
            Err(format!("{reason}\n{CLANG}"))
        }
    }
}

/// Tells Cargo what to link, and the dependents what was found (`DEP_EMBREE_VERSION`, `DEP_EMBREE_RPATH`).
///
/// Link arguments do not reach dependents, so the run path of a library that the loader does not know is only handed
/// on: a dependent's build script sets it, or the user sets `LD_LIBRARY_PATH`.
fn link(embree: &Embree) {
    println!("cargo::rustc-cfg=embree{}", embree.major);
    println!("cargo::rustc-link-search=native={}", embree.lib.display());
    println!("cargo::rustc-link-lib=dylib=embree{}", embree.major);
    println!("cargo::metadata=version={}", embree.version);
    if !embree.lib.starts_with("/usr") && !embree.lib.starts_with("/lib") {
        println!("cargo::rustc-link-arg=-Wl,-rpath,{}", embree.lib.display());
        println!("cargo::metadata=rpath={}", embree.lib.display());
    }
}
