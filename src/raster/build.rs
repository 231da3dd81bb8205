//! The model of a scene.

use std::collections::HashMap;
use std::sync::Arc;

use crate::geometry::Disc;
use crate::model::{
    Averaging, Axis, DebyePole, Excitation, HertzianDipole, Material, MaterialId, Model, Object, Receiver, Source,
    TimeWindow, Voxels, Waveform, WaveformKind,
};
use crate::scene::{Dimension, GeometryKind, Medium, PackingMethod, Scene, Smoothing};

use super::discs::{Block, centres, shares};
use super::placement::Placement;

/// Steps in which a cell's share of stone is held with [`Smoothing::Area`].
const AREA_LEVELS: usize = 32;

/// Why a scene gave no model.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RasterError {
    /// Area smoothing needs cells, not cylinders.
    #[error(
        "`smoothing = \"area\"` cannot be written as cylinders\n\nhint: use `--geometry voxels`, or `--smoothing edges`"
    )]
    AreaNeedsVoxels,
    /// More cells than can be counted sensibly.
    #[error(
        "cells of {cell} m make a grid of {nx} x {ny} x {nz} cells, the limit is {limit} in all\n\nhint: use larger cells with `--cell`"
    )]
    TooManyCells {
        /// Cell size, m.
        cell: f64,
        /// Cells along x.
        nx: usize,
        /// Cells along y.
        ny: usize,
        /// Cells along z.
        nz: usize,
        /// The limit.
        limit: usize,
    },
}

/// Most cells of a model: 40 GB of fields and coefficients in a section, beyond any sensible one; more in space.
const MOST_CELLS: usize = 2_000_000_000;

/// Builds the model of a scene: metal plate, walls and base, bed, antenna.
///
/// # Errors
/// See [`RasterError`].
pub fn build_model(scene: &Scene) -> Result<Model, RasterError> {
    let spec = &scene.spec;
    let placement = Placement::of(spec);
    let [nx, ny, nz] = placement.grid.cells;
    if nx.saturating_mul(ny).saturating_mul(nz) > MOST_CELLS {
        return Err(RasterError::TooManyCells { cell: spec.grid.cell.si(), nx, ny, nz, limit: MOST_CELLS });
    }
    let in_space = spec.grid.dimension == Dimension::Three;
    let mut model = Model::new(spec.title.clone(), placement.grid, TimeWindow::Seconds(spec.grid.time_window.si()));
    model.order = spec.grid.order;
    match spec.grid.smoothing {
        Smoothing::Shapes => model.averaging = Averaging::Shapes,
        Smoothing::Tensors => model.averaging = Averaging::Tensors,
        // In space a cell has no share of its own: each edge takes the mean over its box.
        Smoothing::Area if in_space => model.averaging = Averaging::Volumes,
        _ => {}
    }
    model.pml_cells = Some(placement.absorbing_cells);
    let mut builder = Builder { model, averaging: spec.grid.smoothing != Smoothing::None, known: HashMap::new() };
    builder.tank(scene, &placement);
    match spec.packing.method {
        PackingMethod::Homogeneous => builder.homogeneous_bed(scene, &placement),
        _ if in_space => builder.spheres(scene, &placement),
        _ => builder.stones(scene, &placement)?,
    }
    builder.antenna(scene, &placement);
    Ok(builder.model)
}

/// The same antenna on the same grid with nothing around it: no objects, every open side absorbing.
///
/// A metal plate needs no absorbing cells below it; without the plate they have to be there, or the grid's wall would
/// echo in its place.
pub fn antenna_alone(model: &Model) -> Model {
    let mut alone = model.clone();
    alone.objects.clear();
    let sides = model.absorbing_cells();
    let most = sides.into_iter().max().unwrap_or(0);
    let invariant = model.invariant_axis();
    alone.pml_cells = Some(std::array::from_fn(|side| if Some(side % 3) == invariant { 0 } else { most }));
    alone
}

struct Builder {
    model: Model,
    averaging: bool,
    known: HashMap<String, MaterialId>,
}

impl Builder {
    fn material(&mut self, medium: &Medium) -> MaterialId {
        if medium.is_air() {
            return MaterialId::FREE_SPACE;
        }
        if let Some(id) = self.known.get(&medium.name) {
            return *id;
        }
        let dielectric = &medium.dielectric;
        let mut material = Material::dielectric(&medium.name, dielectric.eps_r, dielectric.sigma.si());
        material.poles =
            dielectric.poles.iter().map(|pole| DebyePole { delta_eps: pole.delta_eps, tau: pole.tau.si() }).collect();
        material.averagable = material.poles.is_empty();
        let id = self.model.add_material(material);
        self.known.insert(medium.name.clone(), id);
        id
    }

    /// A box through the whole depth of the model.
    fn add_box(&mut self, x: [f64; 2], y: [f64; 2], material: MaterialId) {
        let depth = self.model.grid.cells[2] as f64 * self.model.grid.spacing[2];
        self.add_solid(x, y, [0.0, depth], material);
    }

    fn add_solid(&mut self, x: [f64; 2], y: [f64; 2], z: [f64; 2], material: MaterialId) {
        self.model.objects.push(Object::Box {
            lower: [x[0], y[0], z[0]],
            upper: [x[1], y[1], z[1]],
            material,
            averaging: self.averaging && material != MaterialId::PEC,
        });
    }

    /// Metal plate over the whole width, base plate, side walls.
    fn tank(&mut self, scene: &Scene, placement: &Placement) {
        let tank = &scene.spec.tank;
        let [left, floor] = placement.bed_origin;
        let width = placement.grid.cells[0] as f64 * placement.grid.spacing[0];
        if placement.plate_height > 0.0 {
            self.add_box([0.0, width], [0.0, placement.plate_height], MaterialId::PEC);
        }
        let wall_material = self.material(&scene.wall);
        if tank.embedded {
            self.surroundings(scene, placement);
            return;
        }
        let (wall, right) = (tank.wall.si(), left + tank.width.si());
        let [front, back] = bed_depth(scene, placement);
        // In a section the one cell is all the depth there is.
        let outer = if placement.front > 0.0 { [front - wall, back + wall] } else { [front, back] };
        if tank.base.si() > 0.0 {
            self.add_solid([left - wall, right + wall], [floor - tank.base.si(), floor], outer, wall_material);
        }
        if wall > 0.0 {
            let top = floor + tank.height.si();
            self.add_solid([left - wall, left], [floor, top], outer, wall_material);
            self.add_solid([right, right + wall], [floor, top], outer, wall_material);
            if placement.front > 0.0 {
                self.add_solid([left, right], [floor, top], [front - wall, front], wall_material);
                self.add_solid([left, right], [floor, top], [back, back + wall], wall_material);
            }
        }
    }

    /// Base plate and mixture of the bed as far as the model reaches; stones and what lies between them come over it.
    fn surroundings(&mut self, scene: &Scene, placement: &Placement) {
        let tank = &scene.spec.tank;
        let floor = placement.bed_origin[1];
        let x = [0.0, placement.grid.cells[0] as f64 * placement.grid.spacing[0]];
        let (middle, top) = (floor + scene.bed.fouled_height, floor + tank.height.si());
        let layers = [
            ([floor - tank.base.si(), floor], &scene.wall),
            ([floor, middle], &scene.bed.bulk_fouled),
            ([middle, top], &scene.bed.bulk_clean),
        ];
        for (y, medium) in layers.into_iter().filter(|(y, _)| y[1] > y[0]) {
            let material = self.material(medium);
            self.add_box(x, y, material);
        }
    }

    fn homogeneous_bed(&mut self, scene: &Scene, placement: &Placement) {
        let [left, floor] = placement.bed_origin;
        let x = [left, left + scene.spec.tank.width.si()];
        let z = bed_depth(scene, placement);
        let middle = floor + scene.bed.fouled_height;
        let top = floor + scene.spec.tank.height.si();
        if middle > floor {
            let fouled = self.material(&scene.bed.bulk_fouled);
            self.add_solid(x, [floor, middle], z, fouled);
        }
        if top > middle {
            let clean = self.material(&scene.bed.bulk_clean);
            self.add_solid(x, [middle, top], z, clean);
        }
    }

    fn stones(&mut self, scene: &Scene, placement: &Placement) -> Result<(), RasterError> {
        match (scene.spec.grid.geometry, scene.spec.grid.smoothing) {
            (GeometryKind::Cylinders, Smoothing::Area) => return Err(RasterError::AreaNeedsVoxels),
            (GeometryKind::Cylinders, _) | (_, Smoothing::Shapes | Smoothing::Tensors) => {
                self.cylinders(scene, placement)
            }
            (GeometryKind::Voxels, smoothing) => self.voxels(scene, placement, smoothing),
        }
        Ok(())
    }

    /// What fills the voids, zone by zone, as boxes.
    fn voids(&mut self, scene: &Scene, placement: &Placement) {
        let [left, floor] = placement.bed_origin;
        let bed = &scene.bed;
        let x = [left, left + scene.spec.tank.width.si()];
        let z = bed_depth(scene, placement);
        if bed.fouled_height > 0.0 {
            let fines = self.material(&bed.void_fouled);
            self.add_solid(x, [floor, floor + bed.fouled_height], z, fines);
        }
        // In a mixture air has to be cut out.
        if !bed.void_clean.is_air() || scene.spec.tank.embedded {
            let void = self.material(&bed.void_clean);
            self.add_solid(x, [floor + bed.fouled_height, floor + scene.spec.tank.height.si()], z, void);
        }
    }

    /// The voids, then every stone as a ball. A stone belongs to the zone that its centre lies in.
    fn spheres(&mut self, scene: &Scene, placement: &Placement) {
        self.voids(scene, placement);
        let ([left, floor], bed) = (placement.bed_origin, &scene.bed);
        for sphere in scene.spheres.iter().flat_map(|bed| &bed.spheres) {
            let [x, y, z] = sphere.centre;
            let material = self.material(if z < bed.fouled_height { &bed.stone_fouled } else { &bed.stone_clean });
            let centre = [left + x, floor + z, placement.front + y];
            let averaging = self.averaging;
            self.model.objects.push(Object::Sphere { centre, radius: sphere.radius, material, averaging });
        }
    }

    /// The voids, then every stone as a cylinder. A stone belongs to the zone that its centre lies in.
    fn cylinders(&mut self, scene: &Scene, placement: &Placement) {
        self.voids(scene, placement);
        let [left, floor] = placement.bed_origin;
        let (bed, depth) = (&scene.bed, self.model.grid.spacing[2]);
        for disc in scene.discs().iter().filter(|disc| is_drawn(scene, disc)) {
            let stone = if disc.y < bed.fouled_height { &bed.stone_fouled } else { &bed.stone_clean };
            let material = self.material(stone);
            let (x, y) = (left + disc.x, floor + disc.y);
            self.model.objects.push(Object::Cylinder {
                start: [x, y, 0.0],
                end: [x, y, depth],
                radius: disc.radius,
                material,
                averaging: self.averaging,
            });
        }
    }

    /// One block of cells from the floor to the top of the highest stone, true centres.
    fn voxels(&mut self, scene: &Scene, placement: &Placement, smoothing: Smoothing) {
        let (spec, bed) = (&scene.spec, &scene.bed);
        let cell = spec.grid.cell.si();
        let discs = scene.discs();
        let top = discs.iter().map(|disc: &Disc| disc.y + disc.radius).fold(spec.tank.height.si(), f64::max);
        // Cells whose centre lies within the inner faces; the block begins on a node.
        let first = |edge: f64| ((edge / cell - 0.5) - 1e-9).ceil().max(0.0) as usize;
        let [left, floor] = placement.bed_origin;
        let (i0, i1) = (first(left), first(left + spec.tank.width.si()));
        let (j0, j1) = (first(floor), first(floor + top).min(placement.grid.cells[1] - spec.grid.absorbing_cells));
        let shape = [i1.saturating_sub(i0), j1.saturating_sub(j0)];
        let block = Block { origin: [i0 as f64 * cell - left, j0 as f64 * cell - floor], cell, shape };
        let zone_of = |index: usize| {
            let y = block.origin[1] + ((index % shape[1]) as f64 + 0.5) * cell;
            (usize::from(y < bed.fouled_height), y < spec.tank.height.si())
        };
        let media = [[&bed.void_clean, &bed.stone_clean], [&bed.void_fouled, &bed.stone_fouled]];
        let levels = if smoothing == Smoothing::Area { AREA_LEVELS } else { 1 };
        let level: Vec<usize> = if smoothing == Smoothing::Area {
            shares(&block, discs).iter().map(|share| (share * levels as f64).round() as usize).collect()
        } else {
            centres(&block, discs).iter().map(|&stone| usize::from(stone)).collect()
        };
        let mut ids: HashMap<(usize, bool, usize), MaterialId> = HashMap::new();
        let mut cells = Vec::with_capacity(level.len());
        for (index, &level) in level.iter().enumerate() {
            let (zone, in_bed) = zone_of(index);
            let id = *ids.entry((zone, in_bed, level)).or_insert_with(|| {
                let air = Medium::air();
                let void = if in_bed { media[zone][0] } else { &air };
                let medium = blend(void, media[zone][1], level, levels);
                self.material(&medium)
            });
            cells.push(Some(id));
        }
        self.model.objects.push(Object::Voxels(Voxels {
            origin: [i0 as f64 * cell, j0 as f64 * cell, 0.0],
            shape: [shape[0], shape[1], 1],
            cells: Arc::from(cells),
            averaging: self.averaging,
            edges: None,
        }));
    }

    fn antenna(&mut self, scene: &Scene, placement: &Placement) {
        let antenna = &scene.spec.antenna;
        self.model.waveforms.push(Waveform {
            id: "pulse".into(),
            kind: scene.pulse.clone().map_or_else(|| antenna.waveform.clone(), WaveformKind::User),
            amplitude: 1.0,
            frequency: if scene.pulse.is_some() { 0.0 } else { antenna.frequency.si() },
        });
        self.model.sources.push(Source::HertzianDipole(HertzianDipole {
            polarisation: Axis::Z,
            position: placement.source,
            waveform: 0,
            excitation: Excitation { start: 0.0, stop: None },
        }));
        self.model.receivers.push(Receiver { position: placement.receiver, name: None });
    }
}

/// A section cuts some stones so near their rim that the disc may hold no cell's centre (radius below half a diagonal), which
/// painting refuses. They are left out: of stones of 22 to 63 mm in cells of 5 mm that is 0.03 % of their area.
fn is_drawn(scene: &Scene, disc: &Disc) -> bool {
    scene.spheres.is_none() || disc.radius >= scene.spec.grid.cell.si() * std::f64::consts::FRAC_1_SQRT_2
}

/// From where to where the bed reaches along z; in a section the one cell.
fn bed_depth(scene: &Scene, placement: &Placement) -> [f64; 2] {
    match scene.spec.grid.dimension {
        Dimension::Two => [0.0, placement.grid.spacing[2]],
        Dimension::Three => [placement.front, placement.front + scene.spec.tank.inner_depth().si()],
    }
}

/// The mean of void and stone with `level` of `levels` parts of stone. With Ez along the stones the mean over a cell's
/// area is arithmetic, pole by pole.
fn blend(void: &Medium, stone: &Medium, level: usize, levels: usize) -> Medium {
    if level == 0 || level == levels {
        return if level == 0 { void.clone() } else { stone.clone() };
    }
    let share = level as f64 / levels as f64;
    let mean = |a: f64, b: f64| (1.0 - share) * a + share * b;
    let (a, b) = (&void.dielectric, &stone.dielectric);
    let mut poles = Vec::new();
    for (part, weight) in [(a, 1.0 - share), (b, share)] {
        for pole in &part.poles {
            poles.push(crate::material::DebyePole { delta_eps: weight * pole.delta_eps, tau: pole.tau });
        }
    }
    let dielectric = crate::material::Dielectric {
        eps_r: mean(a.eps_r, b.eps_r),
        sigma: crate::units::SiemensPerMetre(mean(a.sigma.si(), b.sigma.si())),
        poles,
    };
    Medium { name: format!("{}_{level}of{levels}_{}", stone.name, void.name), dielectric }
}
