//! A slice that several threads work on in turns. With `instructions` the one place of the engine with `unsafe`.

use std::marker::PhantomData;
use std::ops::Range;

/// A slice lent to a team of threads, which agree by barriers on who reads and who writes what.
#[derive(Debug)]
pub struct Shared<'a, T> {
    start: *mut T,
    len: usize,
    lent: PhantomData<&'a mut [T]>,
}

// SAFETY: a `Shared` only hands out slices by the unsafe methods below, whose callers promise that no two threads hold
// slices of which one may write where the other reads or writes; sending the elements between threads is then all there
// is to it.
unsafe impl<T: Send + Sync> Sync for Shared<'_, T> {}

impl<'a, T> Shared<'a, T> {
    /// Borrows a slice for as long as the team works.
    pub fn new(slice: &'a mut [T]) -> Self {
        Self { start: slice.as_mut_ptr(), len: slice.len(), lent: PhantomData }
    }

    /// The whole slice, to read.
    ///
    /// # Safety
    /// Until the slice is dropped nobody writes to any of it.
    pub unsafe fn read(&self) -> &[T] {
        // SAFETY: pointer and length are those of a slice that is borrowed for 'a; the caller promises that nobody writes.
        unsafe { std::slice::from_raw_parts(self.start, self.len) }
    }

    /// A part of the slice, to write; as much of it as there is.
    ///
    /// # Safety
    /// Until the slice is dropped nobody else reads or writes any of this part.
    #[expect(clippy::mut_from_ref, reason = "the caller promises that parts do not overlap")]
    pub unsafe fn write(&self, part: Range<usize>) -> &mut [T] {
        let (from, to) = (part.start.min(self.len), part.end.min(self.len));
        // SAFETY: the part lies inside the slice that is borrowed for 'a; the caller promises that it is theirs alone.
        unsafe { std::slice::from_raw_parts_mut(self.start.add(from), to.saturating_sub(from)) }
    }
}
