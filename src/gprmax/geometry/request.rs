//! The geometry files that a model asks for: `#geometry_objects_write`.

use std::collections::{BTreeSet, HashMap};
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::super::hdf5::{Hdf5Error, to_bytes};
use super::catalogue::Catalogue;
use super::finished_file::edge_datasets;
use super::voxels::geometry_group;
use super::write_database;
use crate::model::{Finished, GeometryFile, Material, Model, PaintError, paint_finished};

/// The most materials that 16-bit indices with sign can name.
const MOST_MATERIALS: usize = i16::MAX as usize + 1;

/// Why a geometry file was not laid out.
#[derive(Debug, thiserror::Error)]
pub enum GeometryWriteError {
    /// The objects cannot be painted.
    #[error(transparent)]
    Paint(#[from] PaintError),
    /// The HDF5 file could not be laid out.
    #[error(transparent)]
    Hdf5(#[from] Hdf5Error),
    /// The material database could not be laid out.
    #[error("the material database could not be laid out: {0}")]
    Database(#[from] serde_json::Error),
    /// A material that a database of ours cannot hold.
    #[error(
        "`{id}` has Lorentz or Drude poles, which are not written into a material database (`#geometry_objects_write: … {file}`)\n\nhint: `--solver gprmax` runs the file in gprMax itself"
    )]
    Resonant {
        /// Identifier of the material.
        id: String,
        /// Name of the geometry file.
        file: String,
    },
    /// A material that depends on the direction.
    #[error(
        "`{id}` depends on the direction, which is not written into a material database (`#geometry_objects_write: … {file}`)\n\nhint: `--solver gprmax` runs the file in gprMax itself"
    )]
    Directional {
        /// Identifier of the material.
        id: String,
        /// Name of the geometry file.
        file: String,
    },
    /// More materials in one block than 16-bit indices can name.
    #[error("`{file}` would hold {count} materials, gprMax's geometry files hold at most {limit}")]
    TooManyMaterials {
        /// Name of the geometry file.
        file: String,
        /// Materials in the block.
        count: usize,
        /// The most.
        limit: usize,
    },
}

/// Gives the names of the HDF5 file and of the material database beside it, as gprMax 4.0.1 forms them.
///
/// `bed`, `bed.h5` and `bed.x` all become `bed.h5`; the database is `bed_materials.json`, `bed_h5_materials.json` and
/// `bed_x_materials.json`. None for a text that ends in no file name.
pub(in super::super) fn geometry_names(file: &str) -> Option<[PathBuf; 2]> {
    let path = Path::new(file);
    if file.ends_with(['/', '.']) {
        return None;
    }
    let name = path.file_name()?.to_str()?;
    Some([path.with_extension("h5"), path.with_file_name(format!("{}.json", database(name)))])
}

/// Name of the material database: a letter, then letters, digits, `_` and `-`.
fn database(name: &str) -> String {
    let safe: String = name.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect();
    let first = if safe.starts_with(|c: char| c.is_ascii_alphabetic()) { "" } else { "geometry_" };
    format!("{first}{safe}_materials")
}

/// Gives the paths of the geometry files and databases that a model asks for.
pub fn geometry_paths(model: &Model, folder: &Path) -> Vec<PathBuf> {
    let names = model.geometry_files.iter().filter_map(|asked| geometry_names(&asked.file));
    names.flatten().map(|name| folder.join(name)).collect()
}

/// Lays out the geometry files and material databases that a model asks for, each with its path, as gprMax 4 does.
///
/// `/data` is the material of each cell after all objects have been painted, `/rigidE` and `/rigidH` what edges and faces each
/// cell claims, `/ID` what every edge and face is made of; `/material_keys` names the materials among which they count. A voltage
/// with a resistance has no material of its own, which gprMax gives it.
///
/// # Errors
/// When the model cannot be painted or a material cannot be written.
pub fn geometry_files(model: &Model, folder: &Path) -> Result<Vec<(PathBuf, Vec<u8>)>, GeometryWriteError> {
    if model.geometry_files.is_empty() {
        return Ok(vec![]);
    }
    let finished = paint_finished(model)?;
    let catalogue = Catalogue::of(model, &finished);
    let mut files = vec![];
    for asked in &model.geometry_files {
        let Some([geometry, json]) = geometry_names(&asked.file) else { continue };
        let spans = spans(model, asked);
        let data = cells_of(&finished, &spans);
        let mut used: BTreeSet<u32> = data.iter().copied().collect();
        for field in &finished.fields {
            nodes_of(&finished, &spans).for_each(|node| {
                used.insert(catalogue.of_parts[field[node] as usize]);
            });
        }
        let of = |number: u32| &catalogue.materials[number as usize];
        let file = || asked.file.clone();
        if let Some(material) = catalogue.resonant(model, &used) {
            return Err(GeometryWriteError::Resonant { id: material.id.clone(), file: file() });
        }
        if let Some(material) = used.iter().map(|&number| of(number)).find(|m| m.directional.is_some()) {
            return Err(GeometryWriteError::Directional { id: material.id.clone(), file: file() });
        }
        if used.len() > MOST_MATERIALS {
            return Err(GeometryWriteError::TooManyMaterials {
                file: file(),
                count: used.len(),
                limit: MOST_MATERIALS,
            });
        }
        let database = json.file_stem().unwrap_or_default().to_string_lossy();
        let key = |(index, number): (usize, &u32)| {
            let name: String =
                of(*number).id.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
            (format!("material_{index:03}_{name}"), of(*number))
        };
        let materials: Vec<(String, &Material)> = used.iter().enumerate().map(key).collect();
        let keys: Vec<String> = materials.iter().map(|(key, _)| key.clone()).collect();
        let index_of: HashMap<u32, u32> = used.iter().copied().zip(0..).collect();
        let index = |number: u32| index_of.get(&number).copied().unwrap_or_default();
        let data = data.into_iter().map(|number| index(number) as i16).collect();
        let shape = spans.each_ref().map(ExactSizeIterator::len);
        let mut group = geometry_group(model.grid.spacing, &database, &keys, shape, data);
        group.datasets.extend(edge_datasets(&finished, &spans, &|parts| index(catalogue.of_parts[parts])));
        files.push((folder.join(&geometry), to_bytes(&group)?));
        files.push((folder.join(&json), write_database(&database, &materials)?.into_bytes()));
    }
    Ok(files)
}

/// The cells of the grid that a geometry file asks for.
fn spans(model: &Model, asked: &GeometryFile) -> [Range<usize>; 3] {
    std::array::from_fn(|axis| {
        let node = |metres| model.grid.node(axis, metres).clamp(0, model.grid.cells[axis] as i64) as usize;
        node(asked.lower[axis])..node(asked.upper[axis])
    })
}

/// Number of the material of each cell of a block.
fn cells_of(finished: &Finished, [xs, ys, zs]: &[Range<usize>; 3]) -> Vec<u32> {
    let [_, ny, nz] = finished.cells;
    let mut cells = Vec::with_capacity(xs.len() * ys.len() * zs.len());
    for i in xs.clone() {
        for j in ys.clone() {
            let row = &finished.solid[(i * ny + j) * nz..][zs.clone()];
            cells.extend(row.iter().map(|&id| Catalogue::number(id)));
        }
    }
    cells
}

/// Places of the nodes of a block.
fn nodes_of(finished: &Finished, [xs, ys, zs]: &[Range<usize>; 3]) -> impl Iterator<Item = usize> {
    let [_, ny, nz] = finished.cells;
    let (ys, zs) = (ys.clone(), zs.clone());
    let rows = (xs.start..=xs.end).flat_map(move |i| (ys.start..=ys.end).map(move |j| (i * (ny + 1) + j) * (nz + 1)));
    rows.flat_map(move |row| (zs.start..=zs.end).map(move |k| row + k))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Names that gprMax 4.0.1 gave to its files.
    #[test]
    fn files_are_named_as_gprmax_names_them() {
        for (file, geometry, database) in [
            ("whole", "whole.h5", "whole_materials.json"),
            ("ext.h5", "ext.h5", "ext_h5_materials.json"),
            ("2x.y", "2x.h5", "geometry_2x_y_materials.json"),
            ("sub/p-3", "sub/p-3.h5", "sub/p-3_materials.json"),
        ] {
            assert_eq!(geometry_names(file).unwrap(), [PathBuf::from(geometry), PathBuf::from(database)]);
        }
        for none in ["", ".", "..", "sub/", "sub/.."] {
            assert_eq!(geometry_names(none), None, "{none}");
        }
    }
}
