//! Intel Open Image Denoise, loaded when a picture is to be denoised: no build needs it.
//!
//! The few functions used here are declared by hand from its manual; version 2 is asked for, whose names these are.
#![allow(unsafe_code)]

use crate::error::{Error, Result};
use libloading::Library;
use std::env;
use std::ffi::{CStr, OsString, c_char, c_int, c_void};
use std::path::{Path, PathBuf};

type Device = *mut c_void;
type Filter = *mut c_void;

/// Three floats a pixel.
const FLOAT3: c_int = 3;
/// The processor, which every machine has and whose result does not depend on a driver.
const CPU: c_int = 1;

/// A picture and what helps to tell its noise from its detail. All are R G B (or x y z), row by row.
#[derive(Clone, Copy, Debug)]
pub struct Noisy<'p> {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Linear light.
    pub color: &'p [f32],
    /// Reflectance of what is seen, 0..1.
    pub albedo: &'p [f32],
    /// Normals of what is seen.
    pub normal: &'p [f32],
}

/// The functions of the library.
struct Functions {
    new_device: unsafe extern "C" fn(c_int) -> Device,
    commit_device: unsafe extern "C" fn(Device),
    device_error: unsafe extern "C" fn(Device, *mut *const c_char) -> c_int,
    device_int: unsafe extern "C" fn(Device, *const c_char) -> c_int,
    release_device: unsafe extern "C" fn(Device),
    new_filter: unsafe extern "C" fn(Device, *const c_char) -> Filter,
    #[allow(clippy::type_complexity)]
    set_image:
        unsafe extern "C" fn(Filter, *const c_char, *mut c_void, c_int, usize, usize, usize, usize, usize),
    set_bool: unsafe extern "C" fn(Filter, *const c_char, bool),
    commit_filter: unsafe extern "C" fn(Filter),
    execute_filter: unsafe extern "C" fn(Filter),
    release_filter: unsafe extern "C" fn(Filter),
}

/// The denoiser.
pub struct Denoiser {
    functions: Functions,
    device: Device,
    version: String,
    /// Keeps the functions where they are; dropped last.
    _library: Library,
}

impl Denoiser {
    /// Loads it: from the folder `OIDN_DIR` or its `lib`, from where the loader looks, or from a Python environment that
    /// has it.
    ///
    /// # Errors
    /// It was not found, is of another version, or does not start on this processor; the message says how to get it.
    pub fn load() -> Result<Denoiser> {
        let places = places();
        // SAFETY: initialisers of this library need nothing of this program.
        let library = places.iter().find_map(|place| unsafe { Library::new(place) }.ok());
        let library = library.ok_or_else(|| {
            Error::Unavailable(
                "Open Image Denoise was not found: `pip install pyoidn` and set OIDN_DIR to the folder pyoidn/oidn of that \
                 package, or to one of its releases"
                    .into(),
            )
        })?;
        let functions = Functions::of(&library).map_err(|error| {
            Error::Unavailable(format!("this Open Image Denoise is not of version 2: {error}"))
        })?;
        // SAFETY: a device of a known type; null is checked for.
        let device = unsafe { (functions.new_device)(CPU) };
        if device.is_null() {
            return Err(Error::Unavailable("Open Image Denoise does not start on this processor".into()));
        }
        let mut denoiser = Denoiser { functions, device, version: String::new(), _library: library };
        // SAFETY: the device is valid and the name ends with zero.
        let version = unsafe {
            (denoiser.functions.commit_device)(device);
            (denoiser.functions.device_int)(device, c"version".as_ptr())
        };
        denoiser.check()?;
        // As its manual says: 10000 major + 100 minor + patch.
        denoiser.version = format!("{}.{}.{}", version / 10_000, version / 100 % 100, version % 100);
        Ok(denoiser)
    }

    /// Its version, such as 2.5.1.
    pub fn version(&self) -> &str {
        &self.version
    }

    /// The picture without its noise, as the network guesses it.
    ///
    /// # Errors
    /// Planes whose length is not that of the picture; what the library says where it fails, such as too little memory.
    pub fn denoise(&self, noisy: &Noisy<'_>) -> Result<Vec<f32>> {
        let values = 3 * noisy.width as usize * noisy.height as usize;
        let inputs = [(c"color", noisy.color), (c"albedo", noisy.albedo), (c"normal", noisy.normal)];
        if inputs.iter().any(|(_, plane)| plane.len() != values) {
            return Err(Error::Internal("planes of different sizes can't be denoised".into()));
        }
        let mut output = vec![0f32; values];
        let f = &self.functions;
        // SAFETY: the device is valid and the name ends with zero.
        let filter = unsafe { (f.new_filter)(self.device, c"RT".as_ptr()) };
        self.check()?;
        let set = |name: &CStr, plane: *mut f32| {
            let (width, height) = (noisy.width as usize, noisy.height as usize);
            // SAFETY: the plane has width x height x 3 floats without gaps and lives until the filter is released; the
            // library only reads what is not called output.
            unsafe { (f.set_image)(filter, name.as_ptr(), plane.cast(), FLOAT3, width, height, 0, 0, 0) };
        };
        inputs.iter().for_each(|(name, plane)| set(name, plane.as_ptr().cast_mut()));
        set(c"output", output.as_mut_ptr());
        // SAFETY: the filter is valid until it is released, and not used afterwards.
        unsafe {
            (f.set_bool)(filter, c"hdr".as_ptr(), true);
            (f.commit_filter)(filter);
            (f.execute_filter)(filter);
            (f.release_filter)(filter);
        }
        self.check()?;
        Ok(output)
    }

    /// The library's error, if there is one.
    fn check(&self) -> Result<()> {
        let mut message = std::ptr::null();
        // SAFETY: the device is valid; the text lives until the next call.
        let text = unsafe {
            if (self.functions.device_error)(self.device, &raw mut message) == 0 {
                return Ok(());
            }
            if message.is_null() { c"unknown".into() } else { CStr::from_ptr(message).to_owned() }
        };
        Err(Error::Picture(format!("Open Image Denoise failed: {}", text.to_string_lossy())))
    }
}

impl Drop for Denoiser {
    fn drop(&mut self) {
        // SAFETY: the device is not used again, and the library is still loaded.
        unsafe { (self.functions.release_device)(self.device) };
    }
}

impl Functions {
    fn of(library: &Library) -> std::result::Result<Functions, libloading::Error> {
        // SAFETY: names and types are those of version 2's manual.
        unsafe {
            Ok(Functions {
                new_device: *library.get(b"oidnNewDevice\0")?,
                commit_device: *library.get(b"oidnCommitDevice\0")?,
                device_error: *library.get(b"oidnGetDeviceError\0")?,
                device_int: *library.get(b"oidnGetDeviceInt\0")?,
                release_device: *library.get(b"oidnReleaseDevice\0")?,
                new_filter: *library.get(b"oidnNewFilter\0")?,
                set_image: *library.get(b"oidnSetSharedFilterImage\0")?,
                set_bool: *library.get(b"oidnSetFilterBool\0")?,
                commit_filter: *library.get(b"oidnCommitFilter\0")?,
                execute_filter: *library.get(b"oidnExecuteFilter\0")?,
                release_filter: *library.get(b"oidnReleaseFilter\0")?,
            })
        }
    }
}

const NAME: &str = "libOpenImageDenoise.so.2";

/// Where the library may be, the most wanted place first.
fn places() -> Vec<OsString> {
    let mut places = Vec::new();
    if let Some(folder) = env::var_os("OIDN_DIR").map(PathBuf::from) {
        // Who names a folder wants no other.
        return [folder.join("lib").join(NAME), folder.join(NAME)].map(PathBuf::into_os_string).into();
    }
    places.push(NAME.into());
    if let Some(environment) = env::var_os("VIRTUAL_ENV") {
        places.extend(in_python(Path::new(&environment)));
    }
    // Where pip installs without an environment: for one user, and for all.
    if let Some(home) = env::var_os("HOME") {
        places.extend(in_python(&Path::new(&home).join(".local")));
    }
    places.extend(in_python(Path::new("/usr/local")));
    places
}

/// The places of `pyoidn` in the packages of a Python environment; Debian's own Python has another name for their folder.
fn in_python(environment: &Path) -> Vec<OsString> {
    let versions = std::fs::read_dir(environment.join("lib")).into_iter().flatten().flatten();
    let places = |version: std::fs::DirEntry| {
        ["site-packages", "dist-packages"]
            .map(|packages| version.path().join(packages).join("pyoidn/oidn/lib").join(NAME).into_os_string())
    };
    versions.flat_map(places).collect()
}
