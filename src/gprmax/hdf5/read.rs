//! Reading.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use hdf5_pure::{AttrValue, DType, Dataset, Error, File, FormatError};

use super::{Attribute, Hdf5Error};
use crate::files::FileError;

/// Deflate turns at most 1032 bytes into one (zlib's technical notes), so no dataset can be larger than this times its
/// file. A damaged shape is caught by it before memory is asked for.
const LARGEST_EXPANSION: u128 = 1032;

/// The first eight bytes of every HDF5 file that gprMax or h5py writes (format specification, section II.A).
const SIGNATURE: [u8; 8] = *b"\x89HDF\r\n\x1a\n";

/// An open HDF5 file, held in memory.
pub struct H5File {
    path: PathBuf,
    bytes: u64,
    file: File,
}

impl std::fmt::Debug for H5File {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("H5File").field("path", &self.path).finish_non_exhaustive()
    }
}

impl H5File {
    /// Reads a file into memory and checks that it is HDF5.
    ///
    /// # Errors
    /// What the system said; [`Hdf5Error::NotHdf5`]; [`Hdf5Error::Damaged`].
    pub fn open(path: &Path) -> Result<Self, Hdf5Error> {
        let content = fs::read(path).map_err(FileError::of("read", path))?;
        if !content.starts_with(&SIGNATURE) {
            return Err(Hdf5Error::NotHdf5 { path: path.into() });
        }
        let bytes = content.len() as u64;
        let file = guarded(path, || File::from_bytes(content))?;
        let recorded = file.superblock().eof_address;
        let file = Self { path: path.into(), bytes, file };
        if recorded > bytes {
            return Err(file.damaged(format!("it should be {recorded} bytes long but is {bytes}")));
        }
        Ok(file)
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether a group or dataset is there (and readable).
    pub fn has(&self, object: &str) -> bool {
        guarded(&self.path, || {
            Ok(object == "/" || self.file.group(object).is_ok() || self.file.dataset(object).is_ok())
        })
        .unwrap_or(false)
    }

    /// Names of the groups and datasets directly in a group, each sorted so that `rx2` comes before `rx10`.
    ///
    /// # Errors
    /// When the group is missing or damaged.
    pub fn children(&self, group: &str) -> Result<(Vec<String>, Vec<String>), Hdf5Error> {
        self.named(group, || {
            let group = if group == "/" { self.file.root() } else { self.file.group(group)? };
            let (mut groups, mut datasets) = (group.groups()?, group.datasets()?);
            groups.sort_by_key(|name| natural_key(name));
            datasets.sort_by_key(|name| natural_key(name));
            Ok((groups, datasets))
        })
    }

    /// Extents of a dataset.
    ///
    /// # Errors
    /// When the dataset is missing or damaged.
    pub fn shape(&self, dataset: &str) -> Result<Vec<usize>, Hdf5Error> {
        let shape = self.named(dataset, || self.file.dataset(dataset)?.shape())?;
        shape
            .iter()
            .map(|&extent| usize::try_from(extent))
            .collect::<Result<_, _>>()
            .map_err(|_| self.damaged(format!("`{dataset}` has an extent beyond this machine")))
    }

    /// Whether a dataset is stored in double precision.
    ///
    /// # Errors
    /// When the dataset is missing or damaged.
    pub fn is_f64(&self, dataset: &str) -> Result<bool, Hdf5Error> {
        self.named(dataset, || Ok(matches!(self.file.dataset(dataset)?.dtype()?, DType::F64)))
    }

    /// Reads a dataset of floats of either width, in row-major order.
    ///
    /// # Errors
    /// When the dataset is missing, damaged, or does not hold floats.
    pub fn read_f64(&self, dataset: &str) -> Result<Vec<f64>, Hdf5Error> {
        self.read(dataset, "floats", |kind| matches!(kind, DType::F32 | DType::F64), Dataset::read_f64)
    }

    /// Reads a dataset of integers, in row-major order.
    ///
    /// # Errors
    /// When the dataset is missing, damaged, or does not hold integers that fit into 64 bits with sign.
    pub fn read_i64(&self, dataset: &str) -> Result<Vec<i64>, Hdf5Error> {
        let fits = |kind: &DType| {
            matches!(kind, DType::I8 | DType::I16 | DType::I32 | DType::I64 | DType::U8 | DType::U16 | DType::U32)
        };
        self.read(dataset, "integers", fits, Dataset::read_i64)
    }

    /// Reads a dataset of 16-bit integers with sign, and no other, in row-major order.
    ///
    /// # Errors
    /// When the dataset is missing, damaged, or holds another type.
    pub fn read_i16(&self, dataset: &str) -> Result<Vec<i16>, Hdf5Error> {
        self.read(dataset, "16-bit integers with sign", |kind| matches!(kind, DType::I16), Dataset::read_i16)
    }

    /// Reads a dataset of texts, of fixed or variable length.
    ///
    /// # Errors
    /// When the dataset is missing, damaged, or does not hold texts.
    pub fn read_texts(&self, dataset: &str) -> Result<Vec<String>, Hdf5Error> {
        let fits = |kind: &DType| matches!(kind, DType::String | DType::VariableLengthString);
        self.read(dataset, "texts", fits, Dataset::read_string)
    }

    /// An attribute of a group or dataset, `None` when it is not there.
    ///
    /// # Errors
    /// When the object is missing or damaged.
    pub fn attribute(&self, object: &str, name: &str) -> Result<Option<Attribute>, Hdf5Error> {
        let value = self.named(object, || {
            let mut attributes = if object == "/" {
                self.file.root().attrs()?
            } else if let Ok(group) = self.file.group(object) {
                group.attrs()?
            } else {
                self.file.dataset(object)?.attrs()?
            };
            Ok(attributes.remove(name))
        })?;
        Ok(value.map(|value| Attribute::from_hdf5(&value)))
    }

    /// An attribute that must be one float.
    ///
    /// # Errors
    /// When it is missing or something else.
    pub fn float(&self, object: &str, name: &str) -> Result<f64, Hdf5Error> {
        let floats = self.floats(object, name)?;
        match floats[..] {
            [one] => Ok(one),
            _ => Err(self.wrong(object, name, "one float", format!("{} of them", floats.len()))),
        }
    }

    /// An attribute that must hold floats (integers are taken too).
    ///
    /// # Errors
    /// When it is missing or something else.
    pub fn floats(&self, object: &str, name: &str) -> Result<Vec<f64>, Hdf5Error> {
        match self.required(object, name)? {
            Attribute::Floats(values) => Ok(values),
            Attribute::Float(value) => Ok(vec![value]),
            Attribute::Ints(values) => Ok(values.iter().map(|&value| value as f64).collect()),
            Attribute::Int(value) => Ok(vec![value as f64]),
            other => Err(self.wrong(object, name, "floats", other.kind().into())),
        }
    }

    /// An attribute that must hold integers.
    ///
    /// # Errors
    /// When it is missing or something else.
    pub fn integers(&self, object: &str, name: &str) -> Result<Vec<i64>, Hdf5Error> {
        match self.required(object, name)? {
            Attribute::Ints(values) => Ok(values),
            Attribute::Ints32(values) => Ok(values.into_iter().map(i64::from).collect()),
            Attribute::Int(value) => Ok(vec![value]),
            other => Err(self.wrong(object, name, "integers", other.kind().into())),
        }
    }

    /// An attribute that must be a text.
    ///
    /// # Errors
    /// When it is missing or something else.
    pub fn text(&self, object: &str, name: &str) -> Result<String, Hdf5Error> {
        match self.required(object, name)? {
            Attribute::Text(text) => Ok(text),
            other => Err(self.wrong(object, name, "a text", other.kind().into())),
        }
    }

    /// Makes a "should hold ... but holds ..." error about an attribute of this file.
    pub fn wrong(&self, object: &str, name: &str, wanted: &'static str, found: String) -> Hdf5Error {
        Hdf5Error::WrongType { path: self.path.clone(), object: format!("{object} @ {name}"), wanted, found }
    }

    /// Makes a "damaged" error about this file.
    pub fn damaged(&self, reason: String) -> Hdf5Error {
        Hdf5Error::Damaged { path: self.path.clone(), reason }
    }

    fn required(&self, object: &str, name: &str) -> Result<Attribute, Hdf5Error> {
        self.attribute(object, name)?.ok_or_else(|| Hdf5Error::MissingAttribute {
            path: self.path.clone(),
            object: object.into(),
            name: name.into(),
        })
    }

    fn read<T>(
        &self,
        dataset: &str,
        wanted: &'static str,
        fits: impl Fn(&DType) -> bool,
        read: impl Fn(&Dataset) -> Result<Vec<T>, Error>,
    ) -> Result<Vec<T>, Hdf5Error> {
        let (kind, element_size) = self.named(dataset, || {
            let dataset = self.file.dataset(dataset)?;
            Ok((dataset.dtype()?, dataset.element_size()?))
        })?;
        if !fits(&kind) {
            let (path, object) = (self.path.clone(), dataset.into());
            return Err(Hdf5Error::WrongType { path, object, wanted, found: kind.to_string() });
        }
        let count = self.shape(dataset)?.iter().try_fold(1u128, |product, &extent| product.checked_mul(extent as u128));
        let bytes = count.and_then(|count| count.checked_mul(u128::from(element_size))).unwrap_or(u128::MAX);
        if bytes > u128::from(self.bytes) * LARGEST_EXPANSION {
            let (path, object) = (self.path.clone(), dataset.into());
            return Err(Hdf5Error::TooLarge { path, object, bytes, file_bytes: self.bytes });
        }
        let values = self.named(dataset, || read(&self.file.dataset(dataset)?))?;
        if Some(values.len() as u128) != count {
            return Err(self.damaged(format!("`{dataset}` holds {} values, not those of its shape", values.len())));
        }
        Ok(values)
    }

    /// Runs `work` on an object and names that object when it is not there.
    fn named<T>(&self, object: &str, work: impl FnOnce() -> Result<T, Error>) -> Result<T, Hdf5Error> {
        let mut missing = false;
        let result = guarded(&self.path, || {
            work().inspect_err(|error| {
                missing = matches!(
                    error,
                    Error::Format(FormatError::PathNotFound(_)) | Error::NotADataset(_) | Error::NotAGroup(_)
                );
            })
        });
        if missing {
            return Err(Hdf5Error::MissingObject { path: self.path.clone(), object: object.into() });
        }
        result
    }
}

impl Attribute {
    fn from_hdf5(value: &AttrValue) -> Self {
        let scalar = !value.type_name().ends_with("[]");
        if let Some(text) = value.as_str() {
            Self::Text(text.into())
        } else if let Some(integers) = value.to_i64s() {
            if let (true, [one]) = (scalar, &integers[..]) { Self::Int(*one) } else { Self::Ints(integers) }
        } else if let Some(floats) = value.to_f64s() {
            if let (true, [one]) = (scalar, &floats[..]) { Self::Float(*one) } else { Self::Floats(floats) }
        } else {
            Self::Other(value.type_name())
        }
    }
}

/// Turns errors, and panics, of the crate into [`Hdf5Error::Damaged`].
///
/// The crate is young and reads files from anywhere, so a damaged file that trips it must not end the program: this is
/// the one border where a panic is caught. Nothing is shared across it but a file held in memory for reading.
fn guarded<T>(path: &Path, work: impl FnOnce() -> Result<T, Error>) -> Result<T, Hdf5Error> {
    let damaged = |reason: String| Hdf5Error::Damaged { path: path.into(), reason };
    match catch_unwind(AssertUnwindSafe(work)) {
        Ok(Ok(value)) => Ok(value),
        Ok(Err(error)) => Err(damaged(error.to_string())),
        Err(_) => Err(damaged("its structure contradicts itself".into())),
    }
}

/// Sorts `rx2` before `rx10`: the letters, then the number behind them.
fn natural_key(name: &str) -> (String, u64, String) {
    let letters = name.trim_end_matches(|c: char| c.is_ascii_digit());
    (letters.into(), name[letters.len()..].parse().unwrap_or(0), name.into())
}
