//! The bed of balls whose trace tells what accuracy costs in three dimensions.

use rand::RngExt as _;
use rand::SeedableRng as _;
use rand_pcg::Pcg64;

use super::cost::{CostError, CostSetting, CostSubject};
use crate::model::{
    Averaging, Axis, Excitation, Grid, HertzianDipole, Material, Model, Object, Order, Receiver, Source, TimeWindow,
    Waveform, WaveformKind,
};
use crate::scene::Smoothing;
use crate::trace::Component;

/// Balls of the size of ballast on a soil, seen by a dipole above them.
///
/// 160 x 120 x 160 mm without the boundary: 30 mm of soil (`eps_r` 8, 5 mS/m), balls of 22.4 to 40 mm (`eps_r` 6.5, 1 mS/m)
/// in a layer of 85 mm as random sequential addition lays them, source and receiver 40 mm apart and 25 mm above. A Ricker
/// pulse of 1 GHz, 4 ns. The dipoles lie along y, half a cell from a node: all stones lie as much further along y, so that
/// cells of any size that divides 10 mm see the same scene.
#[derive(Debug, Clone)]
pub struct CostBed {
    /// Centre and radius of each ball, m.
    balls: Vec<([f64; 3], f64)>,
}

/// Size without the absorbing boundary, m.
const SIZE: [f64; 3] = [0.16, 0.12, 0.16];
/// Top of the soil, m.
const SOIL: f64 = 0.03;
/// Top of the layer of balls, m.
const TOP: f64 = 0.115;
/// Height of the dipoles, m.
const HEIGHT: f64 = 0.14;
/// Least and largest radius of a ball, m.
const RADII: [f64; 2] = [0.0112, 0.02];
/// Balls that are tried.
const TRIALS: usize = 4000;
/// Depth of the absorbing cells, m, but for ten cells at least.
const ABSORBING_DEPTH: f64 = 0.02;
const FREQUENCY: f64 = 1e9;
const WINDOW: f64 = 4e-9;

impl CostBed {
    /// The bed that the kept table is measured on.
    pub fn standard() -> Self {
        let mut random = Pcg64::seed_from_u64(1);
        let mut balls: Vec<([f64; 3], f64)> = vec![];
        for _ in 0..TRIALS {
            let radius = RADII[0] + (RADII[1] - RADII[0]) * random.random::<f64>();
            let low = [radius, radius, SOIL + radius];
            let high = [SIZE[0] - radius, SIZE[1] - radius, TOP - radius];
            let centre: [f64; 3] =
                std::array::from_fn(|axis| low[axis] + (high[axis] - low[axis]) * random.random::<f64>());
            let is_free = |(other, wide): &([f64; 3], f64)| {
                let squared: f64 = centre.iter().zip(other).map(|(a, b)| (a - b).powi(2)).sum();
                squared >= (radius + wide).powi(2)
            };
            if balls.iter().all(is_free) {
                balls.push((centre, radius));
            }
        }
        Self { balls }
    }

    /// How many balls there are.
    pub fn balls(&self) -> usize {
        self.balls.len()
    }
}

/// Absorbing cells of a depth of 20 mm, ten at least.
fn absorbing(cell: f64) -> usize {
    ((ABSORBING_DEPTH / cell).round() as usize).max(10)
}

impl CostSubject for CostBed {
    fn model(&self, setting: CostSetting) -> Result<Model, CostError> {
        let cell = setting.cell.si();
        let rim = absorbing(cell);
        let cells = SIZE.map(|metres| (metres / cell).round() as usize + 2 * rim);
        let grid = Grid { cells, spacing: [cell; 3] };
        let mut model = Model::new("cost of accuracy in space", grid, TimeWindow::Seconds(WINDOW));
        model.order = setting.order;
        model.pml_cells = Some([rim; 6]);
        model.averaging = match setting.smoothing {
            Smoothing::None | Smoothing::Edges => Averaging::Cells,
            Smoothing::Area => Averaging::Volumes,
            Smoothing::Shapes => Averaging::Shapes,
            Smoothing::Tensors => Averaging::Tensors,
        };
        let averaging = setting.smoothing != Smoothing::None;
        let soil = model.add_material(Material::dielectric("soil", 8.0, 0.005));
        let stone = model.add_material(Material::dielectric("stone", 6.5, 0.001));
        let shift = rim as f64 * cell;
        let whole = cells.map(|count| count as f64 * cell);
        let upper = [whole[0], whole[1], SOIL + shift];
        model.objects.push(Object::Box { lower: [0.0; 3], upper, material: soil, averaging });
        model.objects.extend(self.balls.iter().map(|&([x, y, z], radius)| {
            let centre = [x + shift, y + shift + 0.5 * cell, z + shift];
            Object::Sphere { centre, radius, material: stone, averaging }
        }));
        // A dipole is as long as its edge; its moment stays that of 1 A along 10 mm.
        let (id, amplitude) = ("pulse".to_owned(), 0.01 / cell);
        model.waveforms.push(Waveform { id, kind: WaveformKind::Ricker, amplitude, frequency: FREQUENCY });
        let at = |x: f64| [x + shift, 0.06 + shift, HEIGHT + shift];
        let excitation = Excitation { start: 0.0, stop: None };
        let dipole = HertzianDipole { polarisation: Axis::Y, position: at(0.06), waveform: 0, excitation };
        model.sources.push(Source::HertzianDipole(dipole));
        model.receivers.push(Receiver { position: at(0.10), name: None });
        Ok(model)
    }

    fn frequency(&self) -> f64 {
        FREQUENCY
    }

    fn window(&self) -> f64 {
        WINDOW
    }

    fn component(&self) -> Component {
        Component::Ey
    }

    /// Tensors first: they alone are of second order here, so that their limit is the reference.
    fn smoothings(&self) -> &'static [Smoothing] {
        &[Smoothing::Tensors, Smoothing::Shapes, Smoothing::None, Smoothing::Edges, Smoothing::Area]
    }

    /// The fourth order to 2.5 mm: half of that would take as long as all else together.
    fn orders(&self) -> &'static [(Order, f64)] {
        &[(Order::Second, 0.0), (Order::Fourth, 2.5e-3)]
    }

    /// Without tiles and light cones.
    fn step_of_order_four(&self) -> f64 {
        6.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::paint3;
    use crate::units::Metres;

    /// Random sequential addition ends at about a third of the volume; none of the balls leaves its layer, and source and
    /// receiver lie where they should on every grid.
    #[test]
    fn the_bed_is_one_of_ballast() {
        let bed = CostBed::standard();
        let volume: f64 = bed.balls.iter().map(|(_, r)| 4.0 * std::f64::consts::PI / 3.0 * r.powi(3)).sum();
        let share = volume / (SIZE[0] * SIZE[1] * (TOP - SOIL));
        assert!((0.2..0.4).contains(&share), "{share} in {} balls", bed.balls());
        for cell in [0.01, 0.005, 0.0025] {
            let setting = CostSetting {
                cell: Metres(cell),
                smoothing: Smoothing::Shapes,
                order: Order::Second,
                double_precision: false,
            };
            let model = bed.model(setting).unwrap();
            let rim = absorbing(cell) as f64 * cell;
            let source = model.sources[0].position();
            let node = |axis: usize| model.grid.node(axis, source[axis]) as f64 * cell - rim;
            assert!((node(0) - 0.06).abs() < 1e-9 && (node(2) - 0.14).abs() < 1e-9);
            assert!(paint3(&model).is_ok());
        }
    }
}
