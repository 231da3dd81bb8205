//! The figure of the permittivity map, with antenna, layers and absorbing boundary.

use std::path::{Path, PathBuf};

use crate::cli::cells::Cells;
use crate::cli::error::CliError;
use crate::model::Model;
use crate::plot::{Figure as _, MapFigure, MapLayer, MapSymbol, SymbolKind};
use crate::raster::Placement;
use crate::scene::Scene;

/// Draws the map of a scene into its folder: `map.png` and `map.svg`.
///
/// # Errors
/// When a file cannot be written.
pub fn write(scene: &Scene, model: &Model, cells: &Cells, folder: &Path) -> Result<Vec<PathBuf>, CliError> {
    let map = cells.map(scene, model);
    let values = map.iter().map(|eps| *eps as f32).collect();
    let (nx, ny) = map.dim();
    let [dx, dy, _] = model.grid.spacing;
    let mut figure = MapFigure::new(&scene.spec.title, values, [nx, ny], [nx as f64 * dx, ny as f64 * dy]);
    let pml = model.absorbing_cells().map(|cells| cells as f64);
    figure.absorbing = Some([pml[0] * dx, pml[1] * dy, pml[3] * dx, pml[4] * dy]);
    for source in &model.sources {
        let [x, y, _] = source.position();
        figure.symbols.push(MapSymbol { x, y, label: "source".into(), kind: SymbolKind::Source });
    }
    for receiver in &model.receivers {
        figure.symbols.push(MapSymbol {
            x: receiver.position[0],
            y: receiver.position[1],
            label: "receiver".into(),
            kind: SymbolKind::Receiver,
        });
    }
    let [_, floor] = Placement::of(&scene.spec).bed_origin;
    let mut top = floor + scene.spec.tank.height.si();
    for layer in &scene.layers {
        let bottom = top - layer.thickness.si();
        figure.layers.push(MapLayer { bottom, top, label: layer.name.clone() });
        top = bottom;
    }
    Ok(figure.write(folder, "map")?)
}
