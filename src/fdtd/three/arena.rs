//! Memory for the fields of all planes in one mapping, so that the system can give it in large pages.
//!
//! A page is given when it is touched first. In pages of 4 kB that takes 0.4 s for a lossless model of 200³ cells, a tenth of
//! 300 steps; in pages of 2 MB, a tenth of it. The system gives those only where nothing of a large page has been touched
//! before, which planes that are allocated one by one never leave it.

use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use memmap2::MmapMut;

use super::super::real::Real;

/// Pieces begin at whole multiples of this, bytes: a line of a cache.
const LINE: usize = 64;

/// Memory from which pieces are cut, one after the other.
pub struct Arena {
    mapping: Option<Arc<MmapMut>>,
    start: *mut u8,
    taken: usize,
    size: usize,
}

impl Arena {
    /// Room for so many bytes in all; none where the system gives none, and pieces are then allocated one by one.
    pub fn of_bytes(bytes: u64) -> Self {
        let size = usize::try_from(bytes).unwrap_or(0);
        let mut mapping = if size > 0 { MmapMut::map_anon(size).ok() } else { None };
        #[cfg(target_os = "linux")]
        if let Some(mapping) = &mapping {
            // A wish: without it all is as before, only slower.
            let _ = mapping.advise(memmap2::Advice::HugePage);
        }
        let start = mapping.as_mut().map_or(std::ptr::null_mut(), |mapping| mapping.as_mut_ptr());
        Self { size: if mapping.is_some() { size } else { 0 }, mapping: mapping.map(Arc::new), start, taken: 0 }
    }

    /// Bytes that a piece of `count` numbers takes.
    pub fn bytes<T>(count: usize) -> u64 {
        (count * size_of::<T>()).next_multiple_of(LINE) as u64
    }

    /// `count` zeros.
    pub fn zeros<T: Real>(&mut self, count: usize) -> Piece<T> {
        let bytes = Self::bytes::<T>(count) as usize;
        match &self.mapping {
            Some(mapping) if bytes <= self.size - self.taken => {
                // SAFETY: `taken + bytes` is at most the length of the mapping, so the result lies within it.
                let start = unsafe { self.start.add(self.taken) };
                self.taken += bytes;
                Piece { start: start.cast(), count, _owner: Owner::Mapping { _kept: Arc::clone(mapping) } }
            }
            _ => Piece::from(vec![T::default(); count]),
        }
    }
}

/// Keeps the numbers of a piece where they are.
enum Owner<T> {
    Mapping { _kept: Arc<MmapMut> },
    Alone { _kept: Vec<T> },
}

/// Numbers of an arena, or a vector of its own.
pub struct Piece<T> {
    start: *mut T,
    count: usize,
    _owner: Owner<T>,
}

// SAFETY: a piece owns its numbers alone: pieces of one mapping do not overlap (`Arena::zeros` cuts them one behind the
// other), and nothing else reads or writes the mapping. It can therefore go to another thread as a vector of them can.
unsafe impl<T: Send> Send for Piece<T> {}
// SAFETY: as above; a shared piece only gives shared numbers.
unsafe impl<T: Sync> Sync for Piece<T> {}

impl<T> From<Vec<T>> for Piece<T> {
    fn from(mut numbers: Vec<T>) -> Self {
        Self { start: numbers.as_mut_ptr(), count: numbers.len(), _owner: Owner::Alone { _kept: numbers } }
    }
}

impl<T> Deref for Piece<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        // SAFETY: `start` is where `count` numbers begin that the owner keeps and nobody else reaches: zeros of a mapping,
        // whose bits are a zero of every `Real`, on a line of a cache, or the contents of a vector.
        unsafe { std::slice::from_raw_parts(self.start, self.count) }
    }
}

impl<T> DerefMut for Piece<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        // SAFETY: as in `deref`, and this borrow is the only one.
        unsafe { std::slice::from_raw_parts_mut(self.start, self.count) }
    }
}

impl<T: Clone> Clone for Piece<T> {
    fn clone(&self) -> Self {
        Self::from(self.to_vec())
    }
}

impl<T> std::fmt::Debug for Piece<T> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Piece of {}", self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pieces are zeros, apart, on lines of a cache, and outlive their arena; what does not fit is allocated alone.
    #[test]
    fn pieces_do_not_overlap() {
        let mut arena = Arena::of_bytes(Arena::bytes::<f32>(100) + Arena::bytes::<f64>(30));
        let (mut first, mut second) = (arena.zeros::<f32>(100), arena.zeros::<f64>(30));
        let mut beyond = arena.zeros::<f32>(5);
        drop(arena);
        assert!(first.iter().all(|&v| v == 0.0) && second.iter().all(|&v| v == 0.0));
        first.fill(1.0);
        second.fill(2.0);
        beyond.fill(3.0);
        assert!(first.iter().all(|&v| v == 1.0) && second.iter().all(|&v| v == 2.0));
        assert_eq!((first.len(), second.len(), beyond.len()), (100, 30, 5));
        assert_eq!((first.as_ptr() as usize % LINE, second.as_ptr() as usize % LINE), (0, 0));
        let copy = first.clone();
        drop(first);
        assert_eq!(copy[99], 1.0);
    }
}
