//! `/ID`, `/rigidE` and `/rigidH`: what the cells of a geometry file claim, and what their edges and faces are made of.

use std::path::{Path, PathBuf};

use super::super::hdf5::{Data, Dataset, H5File};
use super::GeometryError;
use crate::model::{BlockEdges, Finished, MaterialId, edge_flag, face_flag};

/// The edge of a cell that each of the twelve arrays of `/rigidE` stands for: its axis, and whether it lies at the high ends of
/// the two others.
const RIGID_E: [(usize, [usize; 2]); 12] = [
    (0, [0, 0]),
    (0, [1, 0]),
    (0, [1, 1]),
    (0, [0, 1]),
    (1, [0, 0]),
    (1, [0, 1]),
    (1, [1, 1]),
    (1, [1, 0]),
    (2, [0, 0]),
    (2, [1, 0]),
    (2, [1, 1]),
    (2, [0, 1]),
];
/// The same for the six of `/rigidH`: the axis that the face lies across, and at which end.
const RIGID_H: [(usize, usize); 6] = [(0, 0), (0, 1), (1, 0), (1, 1), (2, 0), (2, 1)];

/// The three data sets of a file, its indices not looked up yet.
pub struct FileEdges {
    path: PathBuf,
    claims: Vec<u32>,
    /// Index of each of the six fields at each node, and whether it counts.
    fields: [Vec<Option<i64>>; 6],
}

impl FileEdges {
    /// Reads them for a block of so many cells.
    ///
    /// Of `/ID` counts what a cell of the block claims, and what lies on its surface, where cells beside it may claim it: the
    /// edges that nobody claims follow from the cells, as in gprMax.
    pub fn read(file: &H5File, shape: [usize; 3]) -> Result<Self, GeometryError> {
        let [nx, ny, nz] = shape;
        let read = |dataset: &'static str, wanted: Vec<usize>| {
            let found = file.shape(dataset)?;
            if found != wanted {
                return Err(GeometryError::Edges { path: file.path().into(), dataset, shape: found, wanted });
            }
            Ok(file.read_i64(dataset)?)
        };
        let rigid_e = read("/rigidE", vec![12, nx, ny, nz])?;
        let rigid_h = read("/rigidH", vec![6, nx, ny, nz])?;
        let id = read("/ID", vec![6, nx + 1, ny + 1, nz + 1])?;
        let (cells, nodes) = (nx * ny * nz, (nx + 1) * (ny + 1) * (nz + 1));
        let mut claims = vec![0; cells];
        let flags = RIGID_E.map(|(axis, high)| edge_flag(axis, high)).into_iter();
        let flags = flags.chain(RIGID_H.map(|(axis, high)| face_flag(axis, high)));
        for (flag, rigid) in flags.zip(rigid_e.chunks_exact(cells).chain(rigid_h.chunks_exact(cells))) {
            for (claims, _) in claims.iter_mut().zip(rigid).filter(|(_, rigid)| **rigid != 0) {
                *claims |= flag;
            }
        }
        let node = |[i, j, k]: [usize; 3]| (i * (ny + 1) + j) * (nz + 1) + k;
        let mut fields: [Vec<Option<i64>>; 6] = std::array::from_fn(|_| vec![None; nodes]);
        for i in 0..=nx {
            for j in 0..=ny {
                for k in 0..=nz {
                    let at = [i, j, k];
                    if (0..3).any(|axis| at[axis] == 0 || at[axis] == shape[axis]) {
                        fields.iter_mut().zip(id.chunks_exact(nodes)).for_each(|(field, id)| {
                            field[node(at)] = Some(id[node(at)]);
                        });
                    }
                }
            }
        }
        for (cell, claims) in claims.iter().enumerate().filter(|(_, claims)| **claims != 0) {
            let at = [cell / (ny * nz), cell / nz % ny, cell % nz];
            for (axis, high) in RIGID_E.into_iter().filter(|&(axis, high)| claims & edge_flag(axis, high) != 0) {
                let others = [[1, 2], [0, 2], [0, 1]][axis];
                let mut at = at;
                others.into_iter().zip(high).for_each(|(of, high)| at[of] += high);
                fields[axis][node(at)] = Some(id[axis * nodes + node(at)]);
            }
            for (axis, high) in RIGID_H.into_iter().filter(|&(axis, high)| claims & face_flag(axis, high) != 0) {
                let mut at = at;
                at[axis] += high;
                fields[3 + axis][node(at)] = Some(id[(3 + axis) * nodes + node(at)]);
            }
        }
        Ok(Self { path: file.path().into(), claims, fields })
    }

    /// Whether an index counts somewhere.
    pub fn asks_for(&self, index: usize) -> bool {
        self.fields.iter().flatten().any(|found| *found == Some(index as i64))
    }

    /// Looks the indices up in a list of materials.
    pub fn with(self, ids: &[MaterialId], path: &Path) -> Result<BlockEdges, GeometryError> {
        debug_assert_eq!(self.path, path);
        let mut fields: [Vec<MaterialId>; 6] = Default::default();
        for (field, found) in fields.iter_mut().zip(&self.fields) {
            for index in found {
                let Some(index) = *index else {
                    field.push(MaterialId::FREE_SPACE);
                    continue;
                };
                let id = usize::try_from(index).ok().and_then(|index| ids.get(index));
                let last = ids.len() as i64 - 1;
                field.push(*id.ok_or_else(|| GeometryError::EdgeIndex { path: self.path.clone(), index, last })?);
            }
        }
        Ok(BlockEdges { claims: self.claims, fields })
    }
}

/// Lays out the three data sets for a block of a painted grid; `number` gives the index of each entry of its parts.
pub fn edge_datasets(
    finished: &Finished,
    spans: &[std::ops::Range<usize>; 3],
    number: &dyn Fn(usize) -> u32,
) -> Vec<Dataset> {
    let [_, ny, nz] = finished.cells;
    let [xs, ys, zs] = spans.clone();
    let shape = [xs.len(), ys.len(), zs.len()];
    let mut id = vec![];
    for field in &finished.fields {
        for i in xs.start..=xs.end {
            for j in ys.start..=ys.end {
                let row = (i * (ny + 1) + j) * (nz + 1);
                id.extend((zs.start..=zs.end).map(|k| number(field[row + k] as usize)));
            }
        }
    }
    let rigid = |claimed: &dyn Fn(usize) -> bool| {
        let mut values = vec![];
        for i in xs.clone() {
            for j in ys.clone() {
                values.extend(zs.clone().map(|k| i8::from(claimed((i * ny + j) * nz + k))));
            }
        }
        values
    };
    let rigid_e = RIGID_E.iter().flat_map(|&(axis, high)| rigid(&|cell| finished.claims_edge(cell, axis, high)));
    let rigid_h = RIGID_H.iter().flat_map(|&(axis, high)| rigid(&|cell| finished.claims_face(cell, axis, high)));
    let dataset = |name: &str, first: usize, more: usize, data| Dataset {
        name: name.into(),
        shape: std::iter::once(first).chain(shape.map(|cells| cells + more)).collect(),
        data,
        compressed: true,
        attributes: vec![],
    };
    vec![
        dataset("rigidE", 12, 0, Data::I8(rigid_e.collect())),
        dataset("rigidH", 6, 0, Data::I8(rigid_h.collect())),
        dataset("ID", 6, 1, Data::U32(id)),
    ]
}
