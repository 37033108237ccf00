//! OpenImageIO behind the functions of `oiio_shim.cpp`, loaded when a picture first needs it.
//!
//! The shim is a shared object that the binary carries in itself, so it works alike from a build folder, `cargo install`
//! and a package. It is loaded from memory where the system can do that, else from a temporary file.
#![allow(unsafe_code)]

use super::metadata::{Metadata, Value};
use super::{Decoded, Pixels};
use crate::memory::available_bytes;
use libloading::Library;
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::fs::{self, File, OpenOptions};
use std::io::Write;
use std::os::fd::{AsRawFd, FromRawFd};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::sync::OnceLock;

static SHIM: &[u8] = include_bytes!(concat!(env!("OUT_DIR"), "/oiio_shim.so"));

/// A picture of the shim's.
type Handle = *mut c_void;

/// The functions of the shim, in its words.
struct Shim {
    read: unsafe extern "C" fn(*const c_char, u64, *mut Handle, *mut c_char, usize) -> c_int,
    free: unsafe extern "C" fn(Handle),
    size: unsafe extern "C" fn(Handle, *mut c_int, *mut c_int, *mut c_int),
    bytes: unsafe extern "C" fn(Handle) -> *const u8,
    floats: unsafe extern "C" fn(Handle) -> *const f32,
    attribute_count: unsafe extern "C" fn(Handle) -> usize,
    attribute: unsafe extern "C" fn(Handle, usize, *mut *const c_char, *mut *const c_char),
    #[allow(clippy::type_complexity)]
    write: unsafe extern "C" fn(
        *const c_char,
        *const c_char,
        c_int,
        c_int,
        c_int,
        *const c_void,
        *const *const c_char,
        usize,
        *mut c_char,
        usize,
    ) -> c_int,
    /// Keeps the functions where they are.
    _library: Library,
}

/// Whether the library can be used; why not. Loads it.
pub(super) fn check() -> Result<(), String> {
    shim().map(drop)
}

/// The pixels of a file.
pub(super) fn read(path: &Path) -> Result<Decoded, String> {
    let picture = Picture::open(path, available_bytes().unwrap_or(u64::MAX).max(1))?;
    let ([width, height], is_encoded) = picture.size();
    Ok(Decoded { width, height, pixels: picture.pixels(), is_encoded })
}

/// The size of a picture and what its file says.
pub(super) fn info(path: &Path) -> Result<([u32; 2], Metadata), String> {
    let picture = Picture::open(path, 0)?;
    Ok((picture.size().0, picture.metadata()))
}

/// Writes a file in the format of an extension.
pub(super) fn write(
    path: &Path,
    extension: &str,
    (width, height): (u32, u32),
    pixels: &Pixels,
    metadata: &Metadata,
) -> Result<(), String> {
    let shim = shim()?;
    let (bits, data, values): (c_int, *const c_void, usize) = match pixels {
        Pixels::Bytes(values) => (8, values.as_ptr().cast(), values.len()),
        Pixels::Words(values) => (16, values.as_ptr().cast(), values.len()),
        Pixels::Floats(values) => (32, values.as_ptr().cast(), values.len()),
        Pixels::Halves(_) => return Err("only EXR files have half floats".to_owned()),
    };
    if values != width as usize * height as usize * 3 {
        return Err("the pixels do not have the size of the picture".to_owned());
    }
    let text =
        |text: &str| CString::new(text).map_err(|_| "text with a zero byte can't be written".to_owned());
    let texts: Vec<CString> = attributes(metadata, extension)
        .iter()
        .flat_map(|(name, value)| [text(name), text(value)])
        .collect::<Result<_, String>>()?;
    let (path, extension) = (c_path(path)?, text(extension)?);
    let pointers: Vec<*const c_char> = texts.iter().map(|text| text.as_ptr()).collect();
    let [width, height] = [width, height].map(|side| side as c_int);
    checked(|message, size| {
        // SAFETY: all texts end with zero and live until the call returns; `data` has width x height x 3 values of the
        // type that `bits` says; there are twice as many texts as attributes.
        unsafe {
            (shim.write)(
                path.as_ptr(),
                extension.as_ptr(),
                width,
                height,
                bits,
                data,
                pointers.as_ptr(),
                pointers.len() / 2,
                message,
                size,
            )
        }
    })
}

/// What formats without names of one's own hold: `Software` and `DateTime`, and all else as lines of a description.
fn attributes(metadata: &Metadata, extension: &str) -> Vec<(String, String)> {
    let is_common = |name: &str| ["Software", "DateTime", "HostComputer"].contains(&name);
    let mut attributes: Vec<(String, String)> = metadata
        .iter()
        .filter(|(name, _)| is_common(name))
        .map(|(name, value)| (name.to_owned(), value.to_string()))
        .collect();
    let rest = metadata.iter().filter(|(name, _)| !is_common(name));
    let lines: Vec<String> = rest.map(|(name, value)| format!("{name}: {value}")).collect();
    if !lines.is_empty() {
        attributes.push(("ImageDescription".to_owned(), lines.join("\n")));
    }
    if metadata.get("DateTime").is_none() {
        // Else the TIFF writer tells the time, and equal renders would be different files.
        attributes.push(("DateTime".to_owned(), "1970:01:01 00:00:00".to_owned()));
    }
    if extension == "jpg" {
        attributes.push(("Compression".to_owned(), "jpeg:95".to_owned()));
        attributes.push(("jpeg:subsampling".to_owned(), "4:4:4".to_owned()));
    }
    attributes
}

/// A picture that the shim has read.
struct Picture {
    shim: &'static Shim,
    handle: Handle,
}

impl Picture {
    /// Without pixels if `most_bytes` is 0.
    fn open(path: &Path, most_bytes: u64) -> Result<Picture, String> {
        let shim = shim()?;
        let path = c_path(path)?;
        let mut handle = std::ptr::null_mut();
        checked(|message, size| {
            // SAFETY: the path ends with zero, the handle is written before the call returns.
            unsafe { (shim.read)(path.as_ptr(), most_bytes, &raw mut handle, message, size) }
        })?;
        Ok(Picture { shim, handle })
    }

    /// Its size, and whether its values are integers.
    fn size(&self) -> ([u32; 2], bool) {
        let (mut width, mut height, mut is_integer) = (0, 0, 0);
        // SAFETY: the handle is that of a picture, and all three numbers are written.
        unsafe { (self.shim.size)(self.handle, &raw mut width, &raw mut height, &raw mut is_integer) };
        ([width, height].map(|side| side.max(0) as u32), is_integer != 0)
    }

    fn pixels(&self) -> Pixels {
        let [width, height] = self.size().0;
        let values = width as usize * height as usize * 3;
        // SAFETY: the handle is that of a picture; what the two return is null or width x height x 3 values that live as
        // long as the picture.
        unsafe {
            let bytes = (self.shim.bytes)(self.handle);
            if !bytes.is_null() {
                return Pixels::Bytes(std::slice::from_raw_parts(bytes, values).to_vec());
            }
            let floats = (self.shim.floats)(self.handle);
            Pixels::Floats(std::slice::from_raw_parts(floats, values).to_vec())
        }
    }

    /// The attributes; a description by this program is taken apart again.
    fn metadata(&self) -> Metadata {
        let mut metadata = Metadata::default();
        // SAFETY: the handle is that of a picture.
        let count = unsafe { (self.shim.attribute_count)(self.handle) };
        let all: Vec<(String, String)> = (0..count).map(|index| self.attribute(index)).collect();
        let is_own = all.iter().any(|(name, value)| name == "Software" && value.starts_with("pathtracer "));
        for (name, value) in all {
            if is_own && name == "ImageDescription" {
                for (name, value) in value.lines().filter_map(|line| line.split_once(": ")) {
                    metadata.push(name, Value::Text(value.to_owned()));
                }
            } else if !(is_own && name == "IPTC:Caption") {
                // What the JPEG writer repeats the description as.
                metadata.push(name, Value::Text(value));
            }
        }
        metadata
    }

    fn attribute(&self, index: usize) -> (String, String) {
        let (mut name, mut value) = (std::ptr::null(), std::ptr::null());
        // SAFETY: the index is below the count; both texts end with zero and live as long as the picture.
        unsafe {
            (self.shim.attribute)(self.handle, index, &raw mut name, &raw mut value);
            [name, value].map(|text| CStr::from_ptr(text).to_string_lossy().into_owned()).into()
        }
    }
}

impl Drop for Picture {
    fn drop(&mut self) {
        // SAFETY: the handle is not used again.
        unsafe { (self.shim.free)(self.handle) };
    }
}

fn c_path(path: &Path) -> Result<CString, String> {
    CString::new(path.as_os_str().as_bytes()).map_err(|_| "its name holds a zero byte".to_owned())
}

/// Calls a function of the shim with room for a message; the message if it fails.
fn checked(call: impl FnOnce(*mut c_char, usize) -> c_int) -> Result<(), String> {
    let mut message = [0u8; 1024];
    if call(message.as_mut_ptr().cast(), message.len()) == 0 {
        return Ok(());
    }
    let text = CStr::from_bytes_until_nul(&message).unwrap_or_default().to_string_lossy();
    Err(text.trim_end().to_owned())
}

fn shim() -> Result<&'static Shim, String> {
    static LOADED: OnceLock<Result<Shim, String>> = OnceLock::new();
    LOADED.get_or_init(load).as_ref().map_err(String::clone)
}

fn load() -> Result<Shim, String> {
    let library = from_memory().or_else(|_| from_file()).map_err(|error| {
        format!("OpenImageIO can't be loaded (Debian: apt-get install libopenimageio-dev): {error}")
    })?;
    // SAFETY: the names and types are those of `oiio_shim.cpp`, and the library is kept beside the functions.
    let functions = unsafe {
        let get = |error: libloading::Error| error.to_string();
        Shim {
            read: *library.get(b"pt_read\0").map_err(get)?,
            free: *library.get(b"pt_free\0").map_err(get)?,
            size: *library.get(b"pt_size\0").map_err(get)?,
            bytes: *library.get(b"pt_bytes\0").map_err(get)?,
            floats: *library.get(b"pt_floats\0").map_err(get)?,
            attribute_count: *library.get(b"pt_attribute_count\0").map_err(get)?,
            attribute: *library.get(b"pt_attribute\0").map_err(get)?,
            write: *library.get(b"pt_write\0").map_err(get)?,
            _library: library,
        }
    };
    Ok(functions)
}

/// Loads the shim from a file that exists in memory only.
fn from_memory() -> Result<Library, String> {
    // SAFETY: the name ends with zero; the descriptor is checked and belongs to nobody else.
    let mut file = unsafe {
        let descriptor = libc::memfd_create(c"pathtracer-oiio".as_ptr(), libc::MFD_CLOEXEC);
        if descriptor < 0 {
            return Err(std::io::Error::last_os_error().to_string());
        }
        File::from_raw_fd(descriptor)
    };
    file.write_all(SHIM).map_err(|error| error.to_string())?;
    open(Path::new(&format!("/proc/self/fd/{}", file.as_raw_fd())))
}

/// Loads the shim from a new file that only this user can read, and removes the file.
fn from_file() -> Result<Library, String> {
    let path = std::env::temp_dir().join(format!("pathtracer-oiio-{}.so", std::process::id()));
    let mut file = OpenOptions::new()
        .write(true)
        .create_new(true)
        .mode(0o700)
        .open(&path)
        .map_err(|error| format!("{}: {error}", path.display()))?;
    let library = file.write_all(SHIM).map_err(|error| error.to_string()).and_then(|()| open(&path));
    // It may have been removed already, and is not needed any more.
    let _ = fs::remove_file(&path);
    library
}

fn open(path: &Path) -> Result<Library, String> {
    // SAFETY: the file is our own shim; the libraries that come with it are OpenImageIO's, whose initialisers need nothing
    // of this program.
    unsafe { Library::new(path) }.map_err(|error| error.to_string())
}
