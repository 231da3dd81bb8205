//! The coefficients on the edges of a plane: looked up in a small table, or stored where a table would be too large.

use super::super::instructions::InstructionSet;
use super::instructions::{Number, TABLE};
use super::setup::Setup3;
use super::sheet::{LANES, Sheet, padded};

/// No single entry: the edges of the row differ.
const MIXED: u8 = u8::MAX;

/// The coefficients of all entries of the palette, where they fit into a table: `ca`, `cb` along x, y, z.
pub struct Table<T> {
    ca: [T; TABLE],
    cb: [[T; TABLE]; 3],
    /// Fewer than 16 entries.
    few: bool,
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
            few: setup.edges.len() <= 16,
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
    },
    /// One number an edge.
    Stored {
        /// Absent where nothing in the plane conducts.
        ca: Option<Box<[Sheet<T>; 3]>>,
        /// What takes the curl.
        cb: Box<[Sheet<T>; 3]>,
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

/// The coefficients of one row, x, y and z edges.
pub struct RowGrades<'a, T> {
    /// `None` where nothing in the row conducts.
    pub ca: Option<[&'a [T]; 3]>,
    /// What takes the curl.
    pub cb: [&'a [T]; 3],
}

/// Room for looked-up rows.
pub struct Lookup<T> {
    ca: [Vec<T>; 3],
    cb: [Vec<T>; 3],
    /// The entry that a row is filled with, `ca` and `cb`.
    holds: [[u8; 2]; 3],
}

impl<T: Number> Lookup<T> {
    /// Room for rows of `width` nodes.
    pub fn new(width: usize) -> Self {
        let rows = || std::array::from_fn(|_| vec![T::default(); width]);
        Self { ca: rows(), cb: rows(), holds: [[MIXED; 2]; 3] }
    }
}

impl<T: Number> Grades<T> {
    /// Reads the edges of plane `i`.
    pub fn new(setup: &Setup3<'_>, i: usize, indexed: bool) -> Self {
        let [_, ny, nz] = setup.painted.cells;
        let width = padded(nz);
        let lossy: Vec<bool> = (0..ny).map(|j| setup.lossy() && conducts(setup, i, j)).collect();
        if !indexed {
            let mut cb = Box::new(std::array::from_fn(|_| Sheet::zeros(ny - 1, width)));
            let mut ca = lossy.contains(&true).then(|| cb.clone());
            for j in 0..ny {
                for axis in 0..3 {
                    for (k, entry) in entries(setup, axis, i, j).enumerate() {
                        let [a, b] = setup.coefficients(axis, entry);
                        cb[axis].at_mut(j, k, 1)[0] = T::of(b);
                        if let Some(ca) = &mut ca {
                            ca[axis].at_mut(j, k, 1)[0] = T::of(a);
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
        Self::Indexed { index, rows, lossy }
    }

    /// Memory of all planes, bytes.
    pub fn bytes(setup: &Setup3<'_>) -> u64 {
        let [nx, ny, nz] = setup.painted.cells;
        let (width, sheets) = (padded(nz), 3 * Sheet::<T>::bytes(ny - 1, padded(nz)));
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

    /// The coefficients of `n` nodes of row `j` from node `k` on, whole vectors, for the components that are active.
    #[inline(always)]
    pub fn row<'a>(
        &'a self,
        set: InstructionSet,
        table: Option<&Table<T>>,
        j: usize,
        (k, n): (usize, usize),
        active: [bool; 3],
        lookup: &'a mut Lookup<T>,
    ) -> RowGrades<'a, T> {
        let width = lookup.cb[0].len();
        match (self, table) {
            (Self::Indexed { index, rows, lossy }, Some(table)) => {
                let lossy = lossy[j];
                for axis in (0..3).filter(|&axis| active[axis]) {
                    let row = rows[axis][j];
                    let mixed = row.whole == MIXED;
                    let index = if mixed { &index[axis][row.place as usize * width + k..][..n] } else { &[] };
                    let Lookup { ca, cb, holds } = &mut *lookup;
                    let [holds_ca, holds_cb] = &mut holds[axis];
                    fill(set, &table.cb[axis], table.few, row.whole, index, k, &mut cb[axis], holds_cb);
                    if lossy {
                        fill(set, &table.ca, table.few, row.whole, index, k, &mut ca[axis], holds_ca);
                    }
                }
                let part = |[x, y, z]: &'a [Vec<T>; 3]| [&x[k..][..n], &y[k..][..n], &z[k..][..n]];
                RowGrades { ca: lossy.then_some(part(&lookup.ca)), cb: part(&lookup.cb) }
            }
            (Self::Stored { ca, cb, lossy }, _) => {
                let row = |[x, y, z]: &'a [Sheet<T>; 3]| [x.at(j, k, n), y.at(j, k, n), z.at(j, k, n)];
                RowGrades { ca: ca.as_deref().filter(|_| lossy[j]).map(row), cb: row(cb) }
            }
            (Self::Indexed { .. }, None) => {
                let [bx, by, bz] = &lookup.cb;
                RowGrades { ca: None, cb: [bx, by, bz] }
            }
        }
    }
}

/// Fills a row unless it holds the wanted entry already, a mixed one as far as `index` goes from node `k` on.
#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "split off only so that both tables are filled alike")]
fn fill<T: Number>(
    set: InstructionSet,
    table: &[T; TABLE],
    few: bool,
    entry: u8,
    index: &[u8],
    k: usize,
    row: &mut [T],
    holds: &mut u8,
) {
    debug_assert_eq!(row.len() % LANES, 0);
    if entry == MIXED {
        T::look_up(set, table, few, index, &mut row[k..][..index.len()]);
    } else if *holds != entry {
        row.fill(table[usize::from(entry) % TABLE]);
    }
    *holds = entry;
}
