//! Snapshots in gprMax's two layouts: six arrays in HDF5, or an image of cells for ParaView (VTKHDF 2.2).

use std::path::{Path, PathBuf};

use super::super::hdf5::{Attribute, Data, Dataset, Group, H5File, Hdf5Error, to_bytes};
use super::write::LAYOUT;
use crate::model::{Snapshot, SnapshotFormat};
use crate::trace::{Component, FieldSnapshot, FieldValues};
use crate::units::{Metres, Seconds};

/// Gives the path of a snapshot, as gprMax 4 forms it: those of `runs/a.h5` lie in `runs/a_snaps`.
pub fn snapshot_path(result: &Path, snapshot: &Snapshot) -> PathBuf {
    snapshot_folder(result).join(snapshot_file(snapshot))
}

/// Gives the folder of the snapshots of a result.
pub fn snapshot_folder(result: &Path) -> PathBuf {
    let stem = result.file_stem().unwrap_or_default().to_string_lossy();
    result.with_file_name(format!("{stem}_snaps"))
}

/// Gives the name of a snapshot's file.
pub fn snapshot_file(snapshot: &Snapshot) -> String {
    format!("{}.{}", snapshot.name, snapshot.format.ending())
}

/// Lays a snapshot out as gprMax 4 does.
///
/// `.h5` has `Ex` to `Hz` over x, y, z and the time as attributes; `.vtkhdf` the same arrays over z, y, x as the cell data of
/// an image, and no time.
///
/// # Errors
/// When the fields do not have the shape that the snapshot says.
pub fn snapshot_to_bytes(snapshot: &FieldSnapshot, format: SnapshotFormat) -> Result<Vec<u8>, Hdf5Error> {
    match format {
        SnapshotFormat::Hdf5 => to_bytes(&arrays(snapshot)),
        SnapshotFormat::VtkHdf => to_bytes(&image(snapshot)?),
    }
}

fn arrays(snapshot: &FieldSnapshot) -> Group {
    let shape = snapshot.shape;
    let dataset = |(component, values): (Component, &FieldValues)| plain(component.name(), shape.into(), data(values));
    Group {
        name: String::new(),
        attributes: vec![
            ("gprMax", Attribute::Text(LAYOUT.into())),
            ("iteration", Attribute::Int(snapshot.step as i64)),
            ("time", Attribute::Float(snapshot.time.si())),
            ("magnetic_time", Attribute::Float(snapshot.magnetic_time.si())),
            ("nx_ny_nz", Attribute::Ints32(shape.map(|count| count as i32).into())),
            ("dx_dy_dz", floats(snapshot.spacing)),
            ("origin", floats(snapshot.origin)),
        ],
        datasets: Component::FIELDS.into_iter().zip(&snapshot.fields).map(dataset).collect(),
        groups: vec![],
    }
}

fn image(snapshot: &FieldSnapshot) -> Result<Group, Hdf5Error> {
    let [nx, ny, nz] = snapshot.shape;
    let datasets = Component::FIELDS.into_iter().zip(&snapshot.fields).map(|(component, values)| {
        if values.len() != nx * ny * nz {
            let reason = format!("`{}` has {} values for {nx} x {ny} x {nz} cells", component.name(), values.len());
            return Err(Hdf5Error::Encode { reason });
        }
        let columns = (0..nz).flat_map(|k| (0..ny).map(move |j| [j, k]));
        let places = columns.flat_map(|[j, k]| (0..nx).map(move |i| (i * ny + j) * nz + k));
        Ok(plain(component.name(), vec![nz, ny, nx], data(&values.picked(places))))
    });
    let cells = Group { name: "CellData".into(), datasets: datasets.collect::<Result<_, _>>()?, ..Group::default() };
    Ok(vtk_image(snapshot.shape, snapshot.origin, snapshot.spacing, cells))
}

/// A VTKHDF file of a block of cells.
pub fn vtk_image([nx, ny, nz]: [usize; 3], origin: [Metres; 3], spacing: [Metres; 3], cells: Group) -> Group {
    let extent = [0, nx, 0, ny, 0, nz].map(|count| count as i32);
    let vtk = Group {
        name: "VTKHDF".into(),
        attributes: vec![
            ("Version", Attribute::Ints(vec![2, 2])),
            ("Type", Attribute::Ascii("ImageData".into())),
            ("WholeExtent", Attribute::Ints32(extent.into())),
            ("Origin", floats(origin)),
            ("Spacing", floats(spacing)),
            ("Direction", Attribute::Floats32(vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0])),
        ],
        datasets: vec![],
        groups: vec![cells],
    };
    Group { groups: vec![vtk], ..Group::default() }
}

fn floats(lengths: [Metres; 3]) -> Attribute {
    Attribute::Floats(lengths.map(|length| length.si()).into())
}

fn data(values: &FieldValues) -> Data {
    match values {
        FieldValues::Single(values) => Data::F32(values.clone()),
        FieldValues::Double(values) => Data::F64(values.clone()),
    }
}

fn plain(name: &str, shape: Vec<usize>, data: Data) -> Dataset {
    Dataset { name: name.into(), shape, data, compressed: false, attributes: vec![] }
}

/// Reads a snapshot of the layout `.h5`, of gprMax or of this program.
///
/// # Errors
/// When the file is missing or damaged, or lacks something.
pub fn read_snapshot(path: &Path) -> Result<FieldSnapshot, Hdf5Error> {
    let file = H5File::open(path)?;
    let three = |name: &str| {
        let found = file.floats("/", name)?;
        let wrong = || file.wrong("/", name, "three floats", format!("{} of them", found.len()));
        <[f64; 3]>::try_from(&found[..]).map(|lengths| lengths.map(Metres)).map_err(|_| wrong())
    };
    let counts = file.integers("/", "nx_ny_nz")?;
    let wrong = || file.wrong("/", "nx_ny_nz", "three counts above 0", format!("{counts:?}"));
    let shape: Vec<usize> = counts.iter().map_while(|&n| usize::try_from(n).ok().filter(|&n| n > 0)).collect();
    let shape = <[usize; 3]>::try_from(&shape[..]).ok().filter(|_| counts.len() == 3).ok_or_else(wrong)?;
    let mut fields = vec![];
    for component in Component::FIELDS {
        let name = format!("/{}", component.name());
        let found = file.shape(&name)?;
        if found != shape {
            return Err(file.damaged(format!("`{name}` has the shape {found:?}, not {shape:?}")));
        }
        let values = file.read_f64(&name)?;
        fields.push(if file.is_f64(&name)? {
            FieldValues::Double(values)
        } else {
            FieldValues::Single(values.into_iter().map(|value| value as f32).collect())
        });
    }
    let missing = || file.damaged("it does not have six fields".into());
    let step = match file.integers("/", "iteration")?[..] {
        [step] if step >= 0 => step as usize,
        ref other => return Err(file.wrong("/", "iteration", "one count", format!("{other:?}"))),
    };
    Ok(FieldSnapshot {
        step,
        time: Seconds(file.float("/", "time")?),
        magnetic_time: Seconds(file.float("/", "magnetic_time")?),
        origin: three("origin")?,
        spacing: three("dx_dy_dz")?,
        shape,
        fields: fields.try_into().map_err(|_| missing())?,
    })
}
