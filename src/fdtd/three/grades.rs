//! The coefficients on the edges of a plane: looked up in a small table, or stored where a table would be too large.

use super::kernel::{Even, Indexed, Stored, WriteOut};
use super::plane::Shared;
use super::setup::Setup3;
use super::sheet::{Sheets, padded};
use super::vector::{Number, Set, TABLE};

/// No single entry: the edges of the row differ.
const MIXED: u8 = u8::MAX;

/// The coefficients of all entries of the palette, where they fit into a table: `ca`, `cb` along x, y, z.
pub struct Table<T> {
    ca: [T; TABLE],
    cb: [[T; TABLE]; 3],
}

impl<T: Number> Table<T> {
    /// `None` where the palette is too large.
    pub fn new(setup: &Setup3<'_>) -> Option<Self> {
        if setup.edges.len() > TABLE {
            return None;
        }
        let of = |axis: usize, entry: usize| {
            if entry < setup.edges.len() { setup.coefficients(axis, entry) } else { [1.0, 0.0] }
        };
        Some(Self {
            ca: std::array::from_fn(|entry| T::of(of(0, entry)[0])),
            cb: std::array::from_fn(|axis| std::array::from_fn(|entry| T::of(of(axis, entry)[1]))),
        })
    }
}

/// The coefficients on the edges of a plane.
pub enum Grades<T> {
    /// Indices into the table, one byte an edge.
    Indexed {
        /// The rows of x, y and z edges that are not even, `nz` padded to whole vectors for each.
        index: [Vec<u8>; 3],
        /// What each row holds.
        rows: [Vec<RowIndex>; 3],
        /// Whether any edge of a row conducts.
        lossy: Vec<bool>,
        /// Nodes of a row.
        width: usize,
    },
    /// One number an edge.
    Stored {
        /// Along x, y, z; absent where nothing in the plane conducts.
        ca: Option<Sheets<T>>,
        /// What takes the curl.
        cb: Sheets<T>,
        /// Whether any edge of a row conducts.
        lossy: Vec<bool>,
    },
}

/// Where a row's indices are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RowIndex {
    /// The one entry that all edges of the row hold, or [`MIXED`].
    whole: u8,
    /// Place of the indices of a mixed row, in rows.
    place: u32,
}

/// The entries of the palette on a row of edges.
fn entries<'a>(setup: &'a Setup3<'_>, axis: usize, i: usize, j: usize) -> impl Iterator<Item = usize> + use<'a> {
    let first = setup.painted.node([i, j, 0]);
    (first..first + setup.painted.cells[2]).map(move |place| setup.entry(axis, place))
}

/// Whether any edge of a row conducts.
fn conducts(setup: &Setup3<'_>, i: usize, j: usize) -> bool {
    (0..3).any(|axis| entries(setup, axis, i, j).any(|entry| setup.edges[entry].is_lossy()))
}

impl<T: Number> Grades<T> {
    /// Reads the edges of plane `i`.
    pub fn new(setup: &Setup3<'_>, i: usize, indexed: bool) -> Self {
        let [_, ny, nz] = setup.painted.cells;
        let width = padded(nz);
        let lossy: Vec<bool> = (0..ny).map(|j| setup.lossy() && conducts(setup, i, j)).collect();
        if !indexed {
            let mut cb = Sheets::zeros(3, ny - 1, width);
            let mut ca = lossy.contains(&true).then(|| cb.clone());
            for j in 0..ny {
                for axis in 0..3 {
                    for (k, entry) in entries(setup, axis, i, j).enumerate() {
                        let [a, b] = setup.coefficients(axis, entry);
                        cb.at_mut(axis, j, k, 1)[0] = T::of(b);
                        if let Some(ca) = &mut ca {
                            ca.at_mut(axis, j, k, 1)[0] = T::of(a);
                        }
                    }
                }
            }
            return Self::Stored { ca, cb, lossy };
        }
        let (mut index, mut rows): ([Vec<u8>; 3], [Vec<RowIndex>; 3]) = Default::default();
        for axis in 0..3 {
            let (index, rows) = (&mut index[axis], &mut rows[axis]);
            rows.reserve_exact(ny);
            for j in 0..ny {
                let begin = index.len();
                index.extend(entries(setup, axis, i, j).map(|entry| entry as u8));
                let last = index[begin + nz - 1];
                let even = index[begin..].iter().all(|&entry| entry == last);
                index.resize(if even { begin } else { begin + width }, last);
                rows.push(RowIndex { whole: if even { last } else { MIXED }, place: (begin / width) as u32 });
            }
            index.shrink_to_fit();
        }
        Self::Indexed { index, rows, lossy, width }
    }

    /// Memory of all planes, bytes.
    pub fn bytes(setup: &Setup3<'_>) -> u64 {
        let [nx, ny, nz] = setup.painted.cells;
        let (width, sheets) = (padded(nz), Sheets::<T>::bytes(3, ny - 1, padded(nz)));
        let of_plane = |i: usize| -> u64 {
            if setup.edges.len() > TABLE {
                let lossy = setup.lossy() && (0..ny).any(|j| conducts(setup, i, j));
                return sheets * if lossy { 2 } else { 1 };
            }
            let is_mixed = |axis: usize, j: usize| {
                let mut entries = entries(setup, axis, i, j);
                let first = entries.next();
                entries.any(|entry| Some(entry) != first)
            };
            let mixed: usize = (0..3).map(|axis| (0..ny).filter(|&j| is_mixed(axis, j)).count()).sum();
            (mixed * width + 3 * ny * size_of::<RowIndex>()) as u64
        };
        (0..nx).map(|i| of_plane(i) + ny as u64).sum()
    }

    /// Whether any edge of row `j` conducts.
    #[inline(always)]
    pub fn is_lossy(&self, j: usize) -> bool {
        match self {
            Self::Indexed { lossy, .. } | Self::Stored { lossy, .. } => lossy[j],
        }
    }

    /// The coefficients of `n` edges along an axis of row `j` from node `k` on.
    #[inline(always)]
    pub fn of<'a>(&'a self, shared: &'a Shared<T>, axis: usize, (j, k, n): (usize, usize, usize)) -> RowGrade<'a, T> {
        match (self, &shared.table) {
            (Self::Indexed { index, rows, width, .. }, Some(table)) => {
                let RowIndex { whole, place } = rows[axis][j];
                let (ca, cb) = (&table.ca, &table.cb[axis]);
                if whole != MIXED {
                    return RowGrade::Even([ca, cb].map(|table| Even(table[usize::from(whole) % TABLE])));
                }
                let index = &index[axis][place as usize * width + k..][..n];
                RowGrade::Indexed([Indexed { table: ca, index }, Indexed { table: cb, index }])
            }
            (Self::Stored { ca, cb, .. }, _) => {
                let cb = cb.at(axis, j, k, n);
                let ca = ca.as_ref().map_or(&shared.ones[..n], |ca| ca.at(axis, j, k, n));
                RowGrade::Stored([Stored(ca), Stored(cb)])
            }
            (Self::Indexed { .. }, None) => RowGrade::Even([Even(T::default()); 2]),
        }
    }
}

/// `ca` and `cb` along a row of edges.
#[derive(Clone, Copy)]
pub enum RowGrade<'a, T> {
    /// The same everywhere.
    Even([Even<T>; 2]),
    /// Looked up.
    Indexed([Indexed<'a, T>; 2]),
    /// One number an edge.
    Stored([Stored<'a, T>; 2]),
}

impl<'a, T: Number> RowGrade<'a, T> {
    /// `cb` of each edge, written out to `room` where it is not at hand.
    #[inline(always)]
    pub fn scale<S: Set<T>>(self, set: S, room: &'a mut [T]) -> &'a [T] {
        match self {
            Self::Even([_, coefficient]) => set.run(WriteOut { coefficient, out: &mut *room }),
            Self::Indexed([_, coefficient]) => set.run(WriteOut { coefficient, out: &mut *room }),
            Self::Stored([_, Stored(cb)]) => return cb,
        }
        room
    }
}
