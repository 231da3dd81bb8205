//! Writing.

use std::path::Path;

use hdf5_pure::{AttrValue, DatasetBuilder, Error, FileBuilder, GroupBuilder};

use super::Hdf5Error;
use crate::files::write_bytes;

/// Bytes of one compressed block, uncompressed: 256 KiB, as h5py guesses at most.
const CHUNK_BYTES: usize = 256 * 1024;

/// The value of an attribute.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute {
    /// One 64-bit integer.
    Int(i64),
    /// 64-bit integers.
    Ints(Vec<i64>),
    /// 32-bit integers.
    Ints32(Vec<i32>),
    /// One float.
    Float(f64),
    /// Floats.
    Floats(Vec<f64>),
    /// Floats of 32 bits.
    Floats32(Vec<f32>),
    /// A text; h5py sees a `str`.
    Text(String),
    /// A text of ASCII letters, as long as it is; h5py sees `bytes`.
    Ascii(String),
    /// Something no reader here needs, by the name of its type. Not writable.
    Other(&'static str),
}

impl Attribute {
    /// What it holds, in words.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Int(_) | Self::Ints(_) | Self::Ints32(_) => "integers",
            Self::Float(_) | Self::Floats(_) | Self::Floats32(_) => "floats",
            Self::Text(_) | Self::Ascii(_) => "a text",
            Self::Other(kind) => kind,
        }
    }

    fn to_hdf5(&self) -> Result<AttrValue, Hdf5Error> {
        Ok(match self {
            Self::Int(value) => AttrValue::I64(*value),
            Self::Ints(values) => AttrValue::I64Array(values.clone()),
            Self::Ints32(values) => AttrValue::I32Array(values.clone()),
            Self::Float(value) => AttrValue::F64(*value),
            Self::Floats(values) => AttrValue::F64Array(values.clone()),
            Self::Floats32(values) => AttrValue::F32Array(values.clone()),
            Self::Text(text) => AttrValue::VarLenString(text.clone()),
            Self::Ascii(text) => AttrValue::AsciiString(text.clone()),
            Self::Other(kind) => {
                return Err(Hdf5Error::Encode { reason: format!("an attribute of type {kind}") });
            }
        })
    }
}

/// The values of a dataset, in row-major order.
#[derive(Debug, Clone, PartialEq)]
pub enum Data {
    /// Single precision.
    F32(Vec<f32>),
    /// Double precision.
    F64(Vec<f64>),
    /// 16-bit integers with sign.
    I16(Vec<i16>),
    /// 8-bit integers with sign.
    I8(Vec<i8>),
    /// 8-bit integers.
    U8(Vec<u8>),
    /// 32-bit integers with sign.
    I32(Vec<i32>),
    /// 32-bit integers.
    U32(Vec<u32>),
    /// 64-bit integers with sign.
    I64(Vec<i64>),
    /// ASCII texts of one fixed length.
    Texts(Vec<String>),
    /// Texts of any length; h5py sees objects.
    LongTexts(Vec<String>),
}

/// A dataset to write.
#[derive(Debug, Clone, PartialEq)]
pub struct Dataset {
    /// Name within its group.
    pub name: String,
    /// Extents.
    pub shape: Vec<usize>,
    /// Values.
    pub data: Data,
    /// Whether to shuffle and deflate.
    pub compressed: bool,
    /// Attributes.
    pub attributes: Vec<(&'static str, Attribute)>,
}

/// A group to write; the root's name is empty.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Group {
    /// Name within its parent.
    pub name: String,
    /// Attributes.
    pub attributes: Vec<(&'static str, Attribute)>,
    /// Datasets.
    pub datasets: Vec<Dataset>,
    /// Groups.
    pub groups: Vec<Self>,
}

/// Lays a tree out as an HDF5 file.
///
/// # Errors
/// [`Hdf5Error::Encode`], for data that do not fit their shape or an attribute that cannot be written.
pub fn to_bytes(root: &Group) -> Result<Vec<u8>, Hdf5Error> {
    let mut builder = FileBuilder::new();
    for (name, value) in &root.attributes {
        builder.set_attr(name, value.to_hdf5()?);
    }
    for dataset in &root.datasets {
        fill(builder.create_dataset(&dataset.name), dataset)?;
    }
    for group in &root.groups {
        let mut child = builder.create_group(&group.name);
        fill_group(&mut child, group)?;
        builder.add_group(child.finish());
    }
    builder.finish().map_err(encode)
}

/// Writes a tree as an HDF5 file, whole or not at all.
///
/// # Errors
/// As [`to_bytes`], and what the system said.
pub fn write(path: &Path, root: &Group) -> Result<(), Hdf5Error> {
    write_bytes(path, &to_bytes(root)?)?;
    Ok(())
}

fn fill_group(builder: &mut GroupBuilder, group: &Group) -> Result<(), Hdf5Error> {
    for (name, value) in &group.attributes {
        builder.set_attr(name, value.to_hdf5()?);
    }
    for dataset in &group.datasets {
        fill(builder.create_dataset(&dataset.name), dataset)?;
    }
    for inner in &group.groups {
        let mut child = builder.create_group(&inner.name);
        fill_group(&mut child, inner)?;
        builder.add_group(child.finish());
    }
    Ok(())
}

fn fill(builder: &mut DatasetBuilder, dataset: &Dataset) -> Result<(), Hdf5Error> {
    let count: usize = dataset.shape.iter().product();
    let (length, element) = match &dataset.data {
        Data::F32(values) => (values.len(), 4),
        Data::F64(values) => (values.len(), 8),
        Data::I16(values) => (values.len(), 2),
        Data::I8(values) => (values.len(), 1),
        Data::U8(values) => (values.len(), 1),
        Data::I32(values) => (values.len(), 4),
        Data::U32(values) => (values.len(), 4),
        Data::I64(values) => (values.len(), 8),
        Data::Texts(values) | Data::LongTexts(values) => (values.len(), 1),
    };
    if length != count {
        let reason = format!("`{}` has {length} values for the shape {:?}", dataset.name, dataset.shape);
        return Err(Hdf5Error::Encode { reason });
    }
    match &dataset.data {
        Data::F32(values) => builder.with_f32_data(values),
        Data::F64(values) => builder.with_f64_data(values),
        Data::I16(values) => builder.with_i16_data(values),
        Data::I8(values) => builder.with_i8_data(values),
        Data::U8(values) => builder.with_u8_data(values),
        Data::I32(values) => builder.with_i32_data(values),
        Data::U32(values) => builder.with_u32_data(values),
        Data::I64(values) => builder.with_i64_data(values),
        Data::LongTexts(values) => builder.with_vlen_strings(&values.iter().map(String::as_str).collect::<Vec<_>>()),
        Data::Texts(values) => {
            let values: Vec<&str> = values.iter().map(String::as_str).collect();
            builder.with_ascii_strings(&values).map_err(|error| Hdf5Error::Encode { reason: error.to_string() })?
        }
    };
    let shape: Vec<u64> = dataset.shape.iter().map(|&extent| extent as u64).collect();
    builder.with_shape(&shape);
    if dataset.compressed && count > 0 {
        builder.with_chunks(&chunk_shape(&dataset.shape, element)).with_shuffle().with_deflate(6);
    }
    for (name, value) in &dataset.attributes {
        builder.set_attr(name, value.to_hdf5()?);
    }
    Ok(())
}

/// Halves the longest extent until a block is small enough.
fn chunk_shape(shape: &[usize], element: usize) -> Vec<u64> {
    let mut chunk = shape.to_vec();
    while chunk.iter().product::<usize>() * element > CHUNK_BYTES {
        let Some(longest) = chunk.iter_mut().max() else { break };
        *longest = longest.div_ceil(2);
    }
    chunk.iter().map(|&extent| extent as u64).collect()
}

fn encode(error: Error) -> Hdf5Error {
    Hdf5Error::Encode { reason: error.to_string() }
}
