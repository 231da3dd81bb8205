//! From a model to its cells, edges and faces.

use std::sync::atomic::{AtomicBool, Ordering};

use rayon::prelude::*;

use super::PaintError;
use super::chunk::Job;
use super::layout::{Layout, check_two_dimensional};
use super::settle::Settled;
use super::solid::{Solid, description, solids};
use crate::model::averaging::average_shapes;
use crate::model::palette::{FaceMaterial, Palette};
use crate::model::volume::average_volumes;
use crate::model::{Averaging, EdgeMaterial, Indices, Material, MaterialId, Model, Painted, Painted3};

/// Paints the objects of a model that is invariant along z.
///
/// # Errors
/// When the grid is not two-dimensional along z, or an object fills no cell or has no such material.
pub fn paint(model: &Model) -> Result<Painted, PaintError> {
    check_two_dimensional(model)?;
    let whole = Whole::new(model, Layout::new(model.grid, true))?;
    let [_, edges, _] = whole.edges;
    let [nx, ny, _] = model.grid.cells;
    let averaged_edges = whole.averaged[1];
    let mut painted = Painted {
        cells_xy: [nx, ny],
        solid: whole.solid,
        palette: whole.palette,
        edge_z: edges.to_vec(),
        averaged_edges,
    };
    if model.averaging != Averaging::Cells {
        average_shapes(model, &mut painted)?;
    }
    Ok(painted)
}

/// Paints the objects of a model on any grid; [`paint`] gives less for a plane along z.
///
/// 500 balls in 2.3 million cells take 55 ms of one thread (`cargo bench --bench paint`, one thread of a shared machine).
/// Holds eight bytes a cell while it paints, and five when it is done (with up to 256 distinct edge materials).
///
/// # Errors
/// When an object fills no cell or has no such material, or has no volume where means over volumes are asked for.
pub fn paint3(model: &Model) -> Result<Painted3, PaintError> {
    let whole = Whole::new(model, Layout::new(model.grid, false))?;
    let mut painted = Painted3 {
        cells: model.grid.cells,
        solid: whole.solid,
        palette: whole.palette,
        edges: whole.edges,
        face_palette: whole.face_palette,
        faces: whole.faces,
        averaged_edges: whole.averaged,
        couplings: vec![],
    };
    if model.averaging != Averaging::Cells {
        average_volumes(model, &mut painted)?;
    }
    Ok(painted)
}

/// All chunks put together, along the axes of the layout.
struct Whole {
    solid: Vec<MaterialId>,
    palette: Vec<EdgeMaterial>,
    edges: [Indices; 3],
    averaged: [usize; 3],
    face_palette: Vec<FaceMaterial>,
    faces: [Indices; 3],
}

impl Whole {
    fn new(model: &Model, layout: Layout) -> Result<Self, PaintError> {
        let solids = solids(model, &layout)?;
        let filled: Vec<AtomicBool> = solids.iter().map(|_| AtomicBool::new(false)).collect();
        // Faces are settled where an object might have made the grid magnetic.
        let magnetic = |id: MaterialId| model.materials[id.index()].is_magnetic();
        let faces_wanted = !layout.flat && model.materials.iter().any(Material::is_magnetic);
        let per_chunk = layout.planes_per_chunk();
        let lists = by_chunk(&solids, layout.n[0].div_ceil(per_chunk), per_chunk);
        let job = Job {
            layout,
            materials: &model.materials,
            solids: &solids,
            filled: &filled,
            faces_wanted,
            magnetic_averaging: model.magnetic_averaging,
        };
        let mut solid = vec![MaterialId::FREE_SPACE; model.grid.cell_count()];
        let chunks: Vec<Settled> = solid
            .par_chunks_mut(per_chunk * layout.plane())
            .zip(&lists)
            .enumerate()
            .map(|(chunk, (cells, list))| job.run(chunk * per_chunk, cells, list))
            .collect();
        if let Some(index) = filled.iter().position(|filled| !filled.load(Ordering::Relaxed)) {
            return Err(fills_no_cell(model, index));
        }
        let mut whole = Self::joined(solid, &model.materials, chunks);
        if faces_wanted && !whole.solid.par_iter().any(|&id| magnetic(id)) {
            whole.face_palette.clear();
            whole.faces = std::array::from_fn(|_| Indices::with_capacity(0));
        }
        Ok(whole)
    }

    fn joined(solid: Vec<MaterialId>, materials: &[Material], mut chunks: Vec<Settled>) -> Self {
        let mut palette = Palette::new(materials);
        let maps: Vec<_> = chunks.iter().map(|chunk| palette.merge(&chunk.palette)).collect();
        let mut face_palette: Vec<FaceMaterial> = vec![];
        let face_maps: Vec<Vec<u32>> = chunks
            .iter()
            .map(|chunk| chunk.face_palette.iter().map(|&face| place_of(&mut face_palette, face)).collect())
            .collect();
        let mut joined = |of: fn(&mut Settled) -> &mut [Indices; 3], maps: &[Vec<u32>]| {
            std::array::from_fn(|axis| {
                let take = |chunk| std::mem::replace(&mut of(chunk)[axis], Indices::with_capacity(0));
                let lists: Vec<_> = chunks.iter_mut().map(take).collect();
                Indices::joined(&lists, maps)
            })
        };
        let edges = joined(|chunk| &mut chunk.edges, &maps);
        let faces = joined(|chunk| &mut chunk.faces, &face_maps);
        let averaged = std::array::from_fn(|axis| chunks.iter().map(|chunk| chunk.averaged[axis]).sum());
        Self { solid, palette: palette.into_entries(), edges, averaged, face_palette, faces }
    }
}

fn place_of(faces: &mut Vec<FaceMaterial>, face: FaceMaterial) -> u32 {
    let place = faces.iter().position(|known| *known == face).unwrap_or_else(|| {
        faces.push(face);
        faces.len() - 1
    });
    place as u32
}

/// The solids of each chunk of planes and of the plane before it, in order.
fn by_chunk(solids: &[Solid<'_>], chunks: usize, per_chunk: usize) -> Vec<Vec<u32>> {
    let mut lists = vec![vec![]; chunks];
    for (index, solid) in solids.iter().enumerate().filter(|(_, solid)| !solid.cells[0].is_empty()) {
        let planes = &solid.cells[0];
        // A solid's last plane is `end - 1`; the chunk that begins with plane `end` paints it too.
        for list in &mut lists[planes.start / per_chunk..=(planes.end / per_chunk).min(chunks - 1)] {
            list.push(index as u32);
        }
    }
    lists
}

fn fills_no_cell(model: &Model, index: usize) -> PaintError {
    let (kind, material, start) = description(&model.objects[index]);
    let material = model.materials[material.index()].id.clone();
    let flat = model.grid.invariant_axis() == Some(2);
    let cell = model.grid.spacing.iter().take(if flat { 2 } else { 3 }).fold(0.0f64, |longest, d| longest.max(*d));
    PaintError::FillsNoCell { number: index + 1, kind, material, x: start[0], y: start[1], cell }
}
