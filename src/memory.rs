//! Advice about memory, and how much there is.
#![allow(unsafe_code)]

mod available;

pub(crate) use available::available_bytes;
pub use available::available_bytes_below;

/// Asks for huge pages for all that a vector has allocated; best before it is filled. A tree is read in no order: with
/// pages of 4 kB most of the reads in a large one also miss the table of pages.
///
/// Only advice: without huge pages everything works as before.
pub(crate) fn advise_huge_pages<T>(memory: &mut Vec<T>) {
    #[cfg(target_os = "linux")]
    {
        let start = memory.as_mut_ptr() as usize;
        let end = start + memory.capacity() * size_of::<T>();
        let (start, end) = (start.next_multiple_of(HUGE_PAGE), end / HUGE_PAGE * HUGE_PAGE);
        if start < end {
            // SAFETY: the range lies within one allocation, and this advice does not change what is in it.
            unsafe { libc::madvise(start as *mut libc::c_void, end - start, libc::MADV_HUGEPAGE) };
        }
    }
    #[cfg(not(target_os = "linux"))]
    let _ = memory;
}

/// Bytes of a huge page on x86-64.
#[cfg(target_os = "linux")]
const HUGE_PAGE: usize = 2 << 20;
