//! The geometry files that a model asks for: `#geometry_objects_write`.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::super::hdf5::{Hdf5Error, to_bytes};
use super::{voxel_group, write_database};
use crate::model::{GeometryFile, Material, MaterialId, Model, PaintError, Voxels, paint, paint3};

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

/// Lays out the geometry files and material databases that a model asks for, each with its path.
///
/// An HDF5 file holds `/data`, the material of each cell after all objects have been painted, and `/material_keys`: what
/// `#geometry_objects_read` of gprMax 4 and of this crate needs. It holds neither `/ID` nor `/rigidE` nor `/rigidH`: where
/// an object is painted without averaging, or edges belong to plates or sheets, a reader does not find that again.
///
/// # Errors
/// When the model cannot be painted or a material cannot be written.
pub fn geometry_files(model: &Model, folder: &Path) -> Result<Vec<(PathBuf, Vec<u8>)>, GeometryWriteError> {
    if model.geometry_files.is_empty() {
        return Ok(vec![]);
    }
    let solid = if model.is_plane() { paint(model)?.solid } else { paint3(model)?.solid };
    let mut files = vec![];
    for asked in &model.geometry_files {
        let Some([geometry, json]) = geometry_names(&asked.file) else { continue };
        let block = cut(model, &solid, asked);
        let used: BTreeSet<MaterialId> = block.cells.iter().flatten().copied().collect();
        let resonant = used.iter().map(|id| &model.materials[id.index()]).find(|m| !m.resonances.is_empty());
        if let Some(material) = resonant {
            return Err(GeometryWriteError::Resonant { id: material.id.clone(), file: asked.file.clone() });
        }
        if used.len() > MOST_MATERIALS {
            let (file, count, limit) = (asked.file.clone(), used.len(), MOST_MATERIALS);
            return Err(GeometryWriteError::TooManyMaterials { file, count, limit });
        }
        let database = json.file_stem().unwrap_or_default().to_string_lossy();
        let materials: Vec<(String, &Material)> =
            used.iter().map(|id| (format!("m{:05}", id.0), &model.materials[id.index()])).collect();
        let keys: Vec<String> = materials.iter().map(|(key, _)| key.clone()).collect();
        let index_of: HashMap<_, _> = used.into_iter().zip(0i16..).collect();
        let group = voxel_group(&block, model.grid.spacing, &database, &keys, &index_of);
        files.push((folder.join(&geometry), to_bytes(&group)?));
        files.push((folder.join(&json), write_database(&database, &materials)?.into_bytes()));
    }
    Ok(files)
}

/// The cells of a painted grid that a geometry file asks for.
fn cut(model: &Model, solid: &[MaterialId], asked: &GeometryFile) -> Voxels {
    let [_, ny, nz] = model.grid.cells;
    let span = |axis: usize| {
        let node = |metres| model.grid.node(axis, metres).clamp(0, model.grid.cells[axis] as i64) as usize;
        node(asked.lower[axis])..node(asked.upper[axis])
    };
    let [xs, ys, zs] = [0, 1, 2].map(span);
    let mut cells = Vec::with_capacity(xs.len() * ys.len() * zs.len());
    for i in xs.clone() {
        for j in ys.clone() {
            cells.extend(solid[(i * ny + j) * nz..][zs.clone()].iter().copied().map(Some));
        }
    }
    Voxels { origin: asked.lower, shape: [xs.len(), ys.len(), zs.len()], cells: Arc::from(cells), averaging: true }
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
