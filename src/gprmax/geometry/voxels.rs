//! The HDF5 file of a block of voxels.

use std::collections::HashMap;
use std::path::Path;
use std::sync::Arc;

use super::super::hdf5::{Attribute, Data, Dataset, Group, H5File};
use super::finished_file::FileEdges;
use super::{Database, GeometryError};
use crate::model::{Material, MaterialId, Model, Voxels};

/// Largest relative difference of cell sizes that still counts as equal: gprMax compares with NumPy's `isclose`, 1e-5;
/// a tenth of that moves the far end of 10 000 cells by a hundredth of a cell.
const SPACING_TOLERANCE: f64 = 1e-6;

/// Reads a block of voxels and adds its materials to the model.
///
/// A material whose identifier and values the model has already is not added again. One whose identifier the model has with
/// other values gets the identifier `id{database}`, as in gprMax.
pub(in super::super) fn read_voxels(
    model: &mut Model,
    geometry: &Path,
    database: &str,
    origin: [f64; 3],
    averaging: bool,
) -> Result<Voxels, GeometryError> {
    let file = H5File::open(geometry)?;
    let path = || geometry.to_path_buf();
    if !file.has("/material_keys") {
        return Err(GeometryError::OldFormat { path: path() });
    }
    if file.attribute("/", "MaterialDatabase")?.is_some() {
        let recorded = file.text("/", "MaterialDatabase")?;
        if recorded != database {
            return Err(GeometryError::OtherDatabase { path: path(), recorded, given: database.into() });
        }
    }
    let (found, wanted) = (file.floats("/", "dx_dy_dz")?, model.grid.spacing);
    let near = |axis: usize| (found[axis] / wanted[axis] - 1.0).abs() <= SPACING_TOLERANCE;
    if found.len() != 3 || !(0..3).all(near) {
        return Err(GeometryError::Spacing { path: path(), found, wanted });
    }
    let shape = file.shape("/data")?;
    let invariant = model.grid.invariant_axis();
    let fits = shape.len() == 3 && shape.iter().all(|&n| n > 0) && invariant.is_none_or(|axis| shape[axis] == 1);
    if !fits {
        return Err(GeometryError::Shape { path: path(), shape, two_dimensional: invariant.is_some() });
    }
    let data = file.read_i16("/data")?;
    let shape = [shape[0], shape[1], shape[2]];
    let finished = ["/ID", "/rigidE", "/rigidH"].iter().all(|name| file.has(name));
    let edges = if finished { Some(FileEdges::read(&file, shape)?) } else { None };
    let materials = Database::open(&geometry.with_file_name(format!("{database}.json")))?;
    let keys = file.read_texts("/material_keys")?;
    // Means stand in the database too; those that nothing asks for are left there.
    let asked =
        |index: usize| edges.as_ref().is_none_or(|edges| edges.asks_for(index) || data.contains(&(index as i16)));
    let ids = keys
        .iter()
        .enumerate()
        .map(|(index, key)| match asked(index) {
            true if edges.is_some() && materials.is_magnetic_conductor(key) => Ok(MaterialId::FREE_SPACE),
            true => add(model, materials.material(key)?, database, geometry),
            false => Ok(MaterialId::FREE_SPACE),
        })
        .collect::<Result<Vec<_>, GeometryError>>()?;
    let cells = data
        .iter()
        .map(|&index| match usize::try_from(index).map(|index| ids.get(index)) {
            Ok(Some(id)) => Ok(Some(*id)),
            Err(_) if index == -1 => Ok(None),
            _ => Err(GeometryError::Index { path: path(), index, last: ids.len() as i64 - 1 }),
        })
        .collect::<Result<Vec<_>, _>>()?;
    let edges = edges.map(|edges| edges.with(&ids, geometry)).transpose()?.map(Arc::new);
    Ok(Voxels { origin, shape, cells: Arc::from(cells), averaging, edges })
}

/// Finds or adds a material.
fn add(model: &mut Model, mut material: Material, database: &str, path: &Path) -> Result<MaterialId, GeometryError> {
    let same_name = |model: &Model, material: &Material| model.material_named(&material.id);
    if let Some(id) = same_name(model, &material) {
        if model.materials[id.index()] == material {
            return Ok(id);
        }
        material.id = format!("{}{{{database}}}", material.id);
        if let Some(id) = same_name(model, &material).filter(|id| model.materials[id.index()] == material) {
            return Ok(id);
        }
    }
    let limit = usize::from(u16::MAX);
    if model.materials.len() >= limit {
        let count = model.materials.len() + 1;
        return Err(GeometryError::TooManyMaterials { path: path.into(), count, limit });
    }
    Ok(model.add_material(material))
}

/// Lays a block of voxels out for gprMax. `keys` names the materials of the database in the order of their indices.
pub(in super::super) fn voxel_group(
    voxels: &Voxels,
    spacing: [f64; 3],
    database: &str,
    keys: &[String],
    index_of: &HashMap<MaterialId, i16>,
) -> Group {
    let data = voxels.cells.iter().map(|cell| cell.and_then(|id| index_of.get(&id).copied()).unwrap_or(-1)).collect();
    geometry_group(spacing, database, keys, voxels.shape, data)
}

/// The same from indices.
pub(super) fn geometry_group(
    spacing: [f64; 3],
    database: &str,
    keys: &[String],
    shape: [usize; 3],
    data: Vec<i16>,
) -> Group {
    let dataset = |name: &str, shape, data, compressed| Dataset {
        name: name.into(),
        shape,
        data,
        compressed,
        attributes: vec![],
    };
    Group {
        name: String::new(),
        attributes: vec![
            ("dx_dy_dz", Attribute::Floats(spacing.into())),
            ("MaterialDatabase", Attribute::Text(database.into())),
            ("MaterialDatabaseSchemaVersion", Attribute::Int(1)),
            ("Title", Attribute::Text(concat!("written by ballast-gpr ", env!("CARGO_PKG_VERSION")).into())),
        ],
        datasets: vec![
            dataset("data", shape.into(), Data::I16(data), true),
            dataset("material_keys", vec![keys.len()], Data::Texts(keys.into()), false),
        ],
        groups: vec![],
    }
}
