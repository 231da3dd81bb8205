//! The geometry files and the material database that go with an input file.

use std::collections::{BTreeSet, HashMap};
use std::path::{Path, PathBuf};

use super::super::geometry::{voxel_group, write_database};
use super::super::hdf5;
use super::error::WriteError;
use super::number::number;
use crate::files::write_bytes;
use crate::model::{Material, MaterialId, Model, Object, Voxels};

/// The most materials that one block of 16-bit indices with sign can name.
const MOST_MATERIALS: usize = i16::MAX as usize + 1;

/// The files beside an input file.
pub(super) struct VoxelFiles<'a> {
    model: &'a Model,
    stem: String,
    /// Objects that are blocks of voxels which change something: their index among the objects and their file name.
    blocks: Vec<(usize, &'a Voxels, String)>,
    /// Materials in the database.
    in_voxels: BTreeSet<MaterialId>,
    /// Materials of boxes and cylinders.
    in_commands: BTreeSet<MaterialId>,
}

impl<'a> VoxelFiles<'a> {
    /// Collects the voxels of a model.
    pub fn of(model: &'a Model, stem: &str) -> Result<Self, WriteError> {
        let mut files = Self {
            model,
            stem: command_safe(stem),
            blocks: vec![],
            in_voxels: BTreeSet::new(),
            in_commands: BTreeSet::new(),
        };
        for (index, object) in model.objects.iter().enumerate() {
            match object {
                Object::Box { material, .. }
                | Object::Cylinder { material, .. }
                | Object::Sphere { material, .. }
                | Object::Ellipsoid { material, .. }
                | Object::Cone { material, .. }
                | Object::Sector { material, .. }
                | Object::Triangle { material, .. }
                | Object::Plate { material, .. }
                | Object::Edge { material, .. } => {
                    files.in_commands.insert(*material);
                    let parts = model.materials.get(material.index()).and_then(|m| m.directional);
                    files.in_commands.extend(parts.into_iter().flatten());
                }
                Object::Fractal(fractal) => {
                    files.in_commands.extend(&fractal.materials);
                    files.in_commands.extend(fractal.surfaces.iter().filter_map(|s| Some(s.water?.1)));
                }
                Object::Voxels(block) => {
                    if block.edges.is_some() {
                        return Err(WriteError::BlockEdges { number: index + 1 });
                    }
                    let used = used(block);
                    if let Some(id) = used.iter().find(|id| id.index() >= model.materials.len()) {
                        return Err(WriteError::Dangling { what: "material", index: id.index() });
                    }
                    let resonant =
                        used.iter().map(|id| &model.materials[id.index()]).find(|m| !m.resonances.is_empty());
                    if let Some(material) = resonant {
                        return Err(WriteError::Resonant { id: material.id.clone() });
                    }
                    if used.len() > MOST_MATERIALS {
                        return Err(WriteError::TooManyMaterials { count: used.len(), limit: MOST_MATERIALS });
                    }
                    if !used.is_empty() {
                        let number =
                            if files.blocks.is_empty() { String::new() } else { format!("{}", files.blocks.len() + 1) };
                        files.blocks.push((index, block, format!("{}_geometry{number}.h5", files.stem)));
                        files.in_voxels.extend(used);
                    }
                }
            }
        }
        Ok(files)
    }

    /// Whether a material is used by voxels and by nothing else, so that the database alone defines it.
    pub fn only_in_voxels(&self, index: usize) -> bool {
        let id = MaterialId(index as u16);
        self.in_voxels.contains(&id) && !self.in_commands.contains(&id)
    }

    /// The command that reads the block that is object number `index`; none for a block that changes nothing.
    pub fn line(&self, index: usize, block: &Voxels) -> Option<String> {
        let (_, _, file) = self.blocks.iter().find(|(known, _, _)| *known == index)?;
        let origin = block.origin.map(number).join(" ");
        let flag = if block.averaging { "y" } else { "n" };
        Some(format!("#geometry_objects_read: {origin} {file} {} {flag}", self.database()))
    }

    /// Writes the files and gives their paths.
    pub fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, WriteError> {
        let mut written = vec![];
        for (_, block, file) in &self.blocks {
            let ids: Vec<MaterialId> = used(block).into_iter().collect();
            let keys: Vec<String> = ids.iter().copied().map(key).collect();
            let index_of: HashMap<_, _> = ids.into_iter().zip(0i16..).collect();
            let group = voxel_group(block, self.model.grid.spacing, &self.database(), &keys, &index_of);
            let path = folder.join(file);
            hdf5::write(&path, &group)?;
            written.push(path);
        }
        if !self.blocks.is_empty() {
            let materials: Vec<(String, &Material)> =
                self.in_voxels.iter().map(|id| (key(*id), &self.model.materials[id.index()])).collect();
            let path = folder.join(format!("{}.json", self.database()));
            write_bytes(&path, write_database(&self.database(), &materials)?.as_bytes())?;
            written.push(path);
        }
        Ok(written)
    }

    fn database(&self) -> String {
        format!("{}_materials", self.stem)
    }
}

/// The materials of a block.
fn used(block: &Voxels) -> BTreeSet<MaterialId> {
    block.cells.iter().flatten().copied().collect()
}

/// Key of a material in the database; the identifier itself stands beside it, since keys may hold only letters, digits and
/// a few signs.
fn key(id: MaterialId) -> String {
    format!("m{:05}", id.0)
}

/// A name that a command can hold and that gprMax takes as the name of a database: a letter, then letters, digits, `_`, `-`.
pub(super) fn command_safe(stem: &str) -> String {
    let safe: String = stem.chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect();
    if safe.starts_with(|c: char| c.is_ascii_alphabetic()) { safe } else { format!("m{safe}") }
}
