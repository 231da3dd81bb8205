//! The views of the geometry that a model asks for (`#geometry_view`), for ParaView (VTKHDF 2.2).

use std::path::{Path, PathBuf};

use super::super::hdf5::{Attribute, Data, Dataset, Group, to_bytes};
use super::super::output::{LAYOUT, generated, vtk_image};
use super::GeometryWriteError;
use super::catalogue::Catalogue;
use crate::model::{GeometryView, Model, Source, ViewKind, paint, paint_finished, paint3};
use crate::units::Metres;

/// VTK's number of the kind of cell that is a line.
const LINE: u8 = 3;

/// Gives the paths of the views of a result: beside it, with the number of the trace where there are several.
pub fn view_paths(model: &Model, result: &Path, trace: Option<usize>) -> Vec<PathBuf> {
    model.geometry_views.iter().map(|view| view_path(view, result, trace)).collect()
}

fn view_path(view: &GeometryView, result: &Path, trace: Option<usize>) -> PathBuf {
    let stem = Path::new(&view.file).with_extension("");
    let name = stem.file_name().unwrap_or_default().to_string_lossy();
    let number = trace.map_or(String::new(), |trace| trace.to_string());
    result.with_file_name("").join(stem.with_file_name(format!("{name}{number}.vtkhdf")))
}

/// Lays out the views that a model asks for, each with its path, as gprMax 4 does.
///
/// `n` is an image of cells, `f` a grid of lines; `Material` counts into the list `material_ids`: perfect conductors, free
/// space, those of the file, and for edges their means. Sources and receivers stand in `FieldData`. A voltage with a resistance
/// has no material of its own, which gprMax gives it.
///
/// # Errors
/// When the model cannot be painted.
pub fn view_files(
    model: &Model,
    result: &Path,
    trace: Option<usize>,
) -> Result<Vec<(PathBuf, Vec<u8>)>, GeometryWriteError> {
    let wants = |kind| model.geometry_views.iter().any(|view| view.kind == kind);
    let solid = match wants(ViewKind::Cells) {
        false => vec![],
        true if model.is_plane() => paint(model)?.solid,
        true => paint3(model)?.solid,
    };
    let finished = if wants(ViewKind::Edges) { Some(paint_finished(model)?) } else { None };
    let mut files = vec![];
    for view in &model.geometry_views {
        let block = Block::of(model, view);
        let group = match (view.kind, &finished) {
            (ViewKind::Edges, Some(finished)) => {
                let catalogue = Catalogue::of(model, finished);
                let edge = |axis: usize, place: usize| catalogue.of_parts[finished.fields[axis][place] as usize];
                let names = catalogue.materials.iter().map(|material| material.id.clone()).collect();
                block.edges(model, field_data(model, &block, names), &edge)
            }
            _ => {
                let names = Catalogue::plain(model).into_iter().map(|material| material.id).collect();
                let cell = |place: usize| Catalogue::number(solid[place]);
                block.cells(model, field_data(model, &block, names), &cell)
            }
        };
        files.push((view_path(view, result, trace), to_bytes(&group)?));
    }
    Ok(files)
}

/// A view on the grid: its first and last nodes, and the cells of the grid in one of its own.
struct Block {
    first: [usize; 3],
    last: [usize; 3],
    step: [usize; 3],
}

impl Block {
    fn of(model: &Model, view: &GeometryView) -> Self {
        let n = model.grid.cells;
        let node = |axis: usize, metres: f64| model.grid.node(axis, metres).clamp(0, n[axis] as i64) as usize;
        Self {
            first: std::array::from_fn(|axis| node(axis, view.lower[axis])),
            last: std::array::from_fn(|axis| node(axis, view.upper[axis])),
            step: std::array::from_fn(|axis| node(axis, view.spacing[axis]).max(1)),
        }
    }

    fn cells(&self, model: &Model, fields: Group, material: &dyn Fn(usize) -> u32) -> Group {
        let ([_, ny, nz], d) = (model.grid.cells, model.grid.spacing);
        let [xs, ys, zs] = std::array::from_fn(|axis| (self.first[axis]..self.last[axis]).step_by(self.step[axis]));
        let shape = [xs.len(), ys.len(), zs.len()];
        let mut values = Vec::with_capacity(shape.iter().product());
        for k in zs {
            for j in ys.clone() {
                values.extend(xs.clone().map(|i| material((i * ny + j) * nz + k)));
            }
        }
        let reversed = vec![shape[2], shape[1], shape[0]];
        let cells = Group {
            name: "CellData".into(),
            datasets: vec![dataset("Material", reversed, Data::U32(values))],
            ..Group::default()
        };
        let at = |of: [usize; 3]| std::array::from_fn(|axis| Metres(of[axis] as f64 * d[axis]));
        let mut group = vtk_image(shape, at(self.first), at(self.step), cells);
        group.groups.iter_mut().for_each(|vtk| vtk.groups.push(fields.clone()));
        group
    }

    fn edges(&self, model: &Model, fields: Group, material: &dyn Fn(usize, usize) -> u32) -> Group {
        let ([_, ny, nz], d) = (model.grid.cells, model.grid.spacing);
        let count: [usize; 3] = std::array::from_fn(|axis| self.last[axis] - self.first[axis] + 1);
        let nodes = || {
            let rows = (0..count[0]).flat_map(move |i| (0..count[1]).map(move |j| [i, j]));
            rows.flat_map(move |[i, j]| (0..count[2]).map(move |k| [i, j, k]))
        };
        let points: Vec<f64> =
            nodes().flat_map(|node| [0, 1, 2].map(|a| (self.first[a] + node[a]) as f64 * d[a])).collect();
        let strides = [count[1] * count[2], count[2], 1];
        let (mut lines, mut materials) = (vec![], vec![]);
        for axis in 0..3 {
            for node in nodes().filter(|node| node[axis] + 1 < count[axis]) {
                let point: usize = (0..3).map(|a| node[a] * strides[a]).sum();
                lines.extend([point as i32, (point + strides[axis]) as i32]);
                let [i, j, k] = std::array::from_fn(|a| self.first[a] + node[a]);
                materials.push(material(axis, (i * (ny + 1) + j) * (nz + 1) + k));
            }
        }
        let (all, cells) = (points.len() / 3, materials.len());
        let number = |name: &str, value: usize| dataset(name, vec![1], Data::I64(vec![value as i64]));
        let cell_data = Group {
            name: "CellData".into(),
            datasets: vec![dataset("Material", vec![cells], Data::U32(materials))],
            ..Group::default()
        };
        let vtk = Group {
            name: "VTKHDF".into(),
            attributes: vec![
                ("Version", Attribute::Ints(vec![2, 2])),
                ("Type", Attribute::Ascii("UnstructuredGrid".into())),
            ],
            datasets: vec![
                number("NumberOfPoints", all),
                number("NumberOfCells", cells),
                number("NumberOfConnectivityIds", lines.len()),
                dataset("Points", vec![all, 3], Data::F64(points)),
                dataset("Connectivity", vec![lines.len()], Data::I32(lines)),
                dataset("Offsets", vec![cells + 1], Data::I32((0..=cells as i32).map(|cell| 2 * cell).collect())),
                dataset("Types", vec![cells], Data::U8(vec![LINE; cells])),
            ],
            groups: vec![cell_data, fields],
        };
        Group { groups: vec![vtk], ..Group::default() }
    }
}

/// What a view says of the whole model.
fn field_data(model: &Model, block: &Block, names: Vec<String>) -> Group {
    let n = model.grid.cells;
    let absorbing = model.absorbing_cells();
    let thickness = |side: usize| {
        let axis = side % 3;
        let before = if side < 3 { block.first[axis] } else { n[axis] - block.last[axis] };
        absorbing[side].saturating_sub(before) as i64
    };
    let texts = |name: &str, texts: Vec<String>| dataset(name, vec![texts.len()], Data::LongTexts(texts));
    let number = |name: &str| dataset(name, vec![1], Data::I64(vec![1]));
    let mut datasets = vec![
        texts("gprMax_version", vec![LAYOUT.into()]),
        dataset("dx_dy_dz", vec![3], Data::F64(model.grid.spacing.into())),
        dataset("nx_ny_nz", vec![3], Data::I64(n.map(|count| count as i64).into())),
        dataset("pml_thickness", vec![6], Data::I64((0..6).map(thickness).collect())),
        texts("material_ids", names),
        number("source_geometry_schema_version"),
        number("receiver_geometry_schema_version"),
    ];
    let mut things = |what: &str, of: Vec<Thing>| {
        if of.is_empty() {
            return;
        }
        let d = model.grid.spacing;
        let all = |text: fn(&Thing) -> String| of.iter().map(text).collect::<Vec<_>>();
        let places = of.iter().flat_map(|thing| [0, 1, 2].map(|a| thing.node[a] as f64 * d[a])).collect();
        let bounds = of.iter().flat_map(|thing| {
            [0, 1, 2].map(|a| [0, 1].map(|end| (thing.node[a] + end) as f64 * d[a])).into_iter().flatten()
        });
        datasets.push(dataset(&format!("{what}s"), vec![of.len(), 3], Data::F64(places)));
        datasets.push(dataset(&format!("{what}_geometry_bounds"), vec![of.len(), 6], Data::F64(bounds.collect())));
        datasets.push(texts(&format!("{what}_ids"), all(|thing| thing.id.clone())));
        if what == "source" {
            datasets.push(texts("source_types", all(|thing| thing.kind.into())));
        }
        datasets.push(texts(&format!("{what}_geometry_ids"), all(|thing| thing.port().0)));
        datasets.push(texts(&format!("{what}_geometry_kinds"), all(|_| "point".into())));
        datasets.push(texts(&format!("{what}_geometry_types"), all(|thing| thing.port().1.into())));
    };
    things("source", sources(model));
    things("receiver", receivers(model));
    Group { name: "FieldData".into(), datasets, ..Group::default() }
}

/// A source or receiver.
struct Thing {
    kind: &'static str,
    id: String,
    node: [i64; 3],
    /// Number of its port, from 1.
    port: Option<usize>,
}

impl Thing {
    /// Its name and kind, those of its port where it has one.
    fn port(&self) -> (String, &'static str) {
        match self.port {
            Some(number) => (format!("port{number}"), "VoltageSourcePort"),
            None => (self.id.clone(), self.kind),
        }
    }
}

fn node_of(model: &Model, position: [f64; 3]) -> [i64; 3] {
    std::array::from_fn(|axis| model.grid.node(axis, position[axis]))
}

/// The sources in gprMax's order: currents, magnetic dipoles, voltages. Voltages are ports in three dimensions.
fn sources(model: &Model) -> Vec<Thing> {
    let kinds = ["HertzianDipole", "MagneticDipole", "VoltageSource"];
    let place = |source: &Source| match source {
        Source::HertzianDipole(_) => 0,
        Source::MagneticDipole(_) => 1,
        Source::VoltageSource(_) => 2,
    };
    let mut sources: Vec<&Source> = model.sources.iter().collect();
    sources.sort_by_key(|source| place(source));
    let mut ports = 0;
    let thing = |source: &Source| {
        let (kind, node) = (kinds[place(source)], node_of(model, source.position()));
        let port = (place(source) == 2 && model.invariant_axis().is_none()).then(|| {
            ports += 1;
            ports
        });
        Thing { kind, id: generated(kind, &node.map(|index| index as i32)), node, port }
    };
    sources.into_iter().map(thing).collect()
}

fn receivers(model: &Model) -> Vec<Thing> {
    let thing = |receiver: &crate::model::Receiver| {
        let node = node_of(model, receiver.position);
        let id = receiver.name.clone().unwrap_or_else(|| generated("Rx", &node.map(|index| index as i32)));
        Thing { kind: "Rx", id, node, port: None }
    };
    model.receivers.iter().map(thing).collect()
}

fn dataset(name: &str, shape: Vec<usize>, data: Data) -> Dataset {
    Dataset { name: name.into(), shape, data, compressed: false, attributes: vec![] }
}
