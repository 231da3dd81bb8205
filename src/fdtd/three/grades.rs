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
    /// Indices into the table, `nz` padded to whole vectors for each row of x, y and z edges.
    Indexed {
        /// One byte an edge.
        index: [Vec<u8>; 3],
        /// The one entry that all edges of a row hold, or [`MIXED`].
        whole: [Vec<u8>; 3],
        /// Whether any edge of a row conducts.
        lossy: Vec<bool>,
    },
    /// One number an edge.
    Stored {
        /// Absent where nothing on the grid conducts.
        ca: Option<Box<[Sheet<T>; 3]>>,
        /// What takes the curl.
        cb: Box<[Sheet<T>; 3]>,
    },
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
        if !indexed {
            let mut cb = Box::new(std::array::from_fn(|_| Sheet::zeros(ny - 1, width)));
            let mut ca = setup.lossy().then(|| cb.clone());
            for j in 0..ny {
                let first = setup.painted.node([i, j, 0]);
                for axis in 0..3 {
                    for k in 0..nz {
                        let entry = setup.painted.edges[axis].get(first + k) as usize;
                        let [a, b] = setup.coefficients(axis, entry);
                        cb[axis].at_mut(j, k, 1)[0] = T::of(b);
                        if let Some(ca) = &mut ca {
                            ca[axis].at_mut(j, k, 1)[0] = T::of(a);
                        }
                    }
                }
            }
            return Self::Stored { ca, cb };
        }
        let mut index: [Vec<u8>; 3] = std::array::from_fn(|_| vec![0; ny * width]);
        let mut whole: [Vec<u8>; 3] = std::array::from_fn(|_| vec![MIXED; ny]);
        let mut lossy = vec![false; ny];
        for j in 0..ny {
            let first = setup.painted.node([i, j, 0]);
            for axis in 0..3 {
                let row = &mut index[axis][j * width..][..width];
                for (k, entry) in row[..nz].iter_mut().enumerate() {
                    *entry = setup.painted.edges[axis].get(first + k) as u8;
                }
                let last = row[nz - 1];
                row[nz..].fill(last);
                if row.iter().all(|&entry| entry == last) {
                    whole[axis][j] = last;
                }
                lossy[j] |= row.iter().any(|&entry| setup.edges[usize::from(entry)].is_lossy());
            }
        }
        Self::Indexed { index, whole, lossy }
    }

    /// Memory of all planes, bytes.
    pub fn bytes(setup: &Setup3<'_>) -> u64 {
        let [nx, ny, nz] = setup.painted.cells;
        let width = padded(nz);
        let plane = if setup.edges.len() <= TABLE {
            (3 * ny * (width + 1) + ny) as u64
        } else {
            Sheet::<T>::bytes(ny - 1, width) * if setup.lossy() { 6 } else { 3 }
        };
        plane * nx as u64
    }

    /// The coefficients of row `j`.
    #[inline(always)]
    pub fn row<'a>(
        &'a self,
        set: InstructionSet,
        table: Option<&Table<T>>,
        j: usize,
        lookup: &'a mut Lookup<T>,
    ) -> RowGrades<'a, T> {
        let width = lookup.cb[0].len();
        match (self, table) {
            (Self::Indexed { index, whole, lossy }, Some(table)) => {
                let lossy = lossy[j];
                for axis in 0..3 {
                    let (entry, index) = (whole[axis][j], &index[axis][j * width..][..width]);
                    let Lookup { ca, cb, holds } = &mut *lookup;
                    let [holds_ca, holds_cb] = &mut holds[axis];
                    fill(set, &table.cb[axis], table.few, entry, index, &mut cb[axis], holds_cb);
                    if lossy {
                        fill(set, &table.ca, table.few, entry, index, &mut ca[axis], holds_ca);
                    }
                }
                let [ax, ay, az] = &lookup.ca;
                let [bx, by, bz] = &lookup.cb;
                RowGrades { ca: lossy.then_some([&ax[..], ay, az]), cb: [bx, by, bz] }
            }
            (Self::Stored { ca, cb }, _) => {
                let row = |sheets: &'a [Sheet<T>; 3]| {
                    let [x, y, z] = sheets;
                    [x.at(j, 0, width), y.at(j, 0, width), z.at(j, 0, width)]
                };
                RowGrades { ca: ca.as_deref().map(row), cb: row(cb) }
            }
            (Self::Indexed { .. }, None) => {
                let [bx, by, bz] = &lookup.cb;
                RowGrades { ca: None, cb: [bx, by, bz] }
            }
        }
    }
}

/// Fills a row unless it holds the wanted entry already.
#[inline(always)]
fn fill<T: Number>(
    set: InstructionSet,
    table: &[T; TABLE],
    few: bool,
    entry: u8,
    index: &[u8],
    row: &mut [T],
    holds: &mut u8,
) {
    debug_assert_eq!(row.len() % LANES, 0);
    if entry == MIXED {
        T::look_up(set, table, few, index, row);
    } else if *holds != entry {
        row.fill(table[usize::from(entry) % TABLE]);
    }
    *holds = entry;
}
