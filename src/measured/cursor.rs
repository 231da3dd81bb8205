//! Numbers out of bytes: every access is bounded, and a failure names the field and where it stands.

use std::path::Path;

use super::error::MeasuredError;
use super::recording::SampleKind;

/// Which byte of a number comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ByteOrder {
    Little,
    Big,
}

impl ByteOrder {
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Little => "little-endian",
            Self::Big => "big-endian",
        }
    }
}

/// The bytes of a file.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bytes<'a> {
    pub(super) path: &'a Path,
    pub(super) bytes: &'a [u8],
    pub(super) order: ByteOrder,
}

impl<'a> Bytes<'a> {
    pub(super) fn little(path: &'a Path, bytes: &'a [u8]) -> Self {
        Self { path, bytes, order: ByteOrder::Little }
    }

    pub(super) fn size(&self) -> usize {
        self.bytes.len()
    }

    /// `count` bytes at `offset`.
    pub(super) fn slice(&self, field: &str, offset: usize, count: usize) -> Result<&'a [u8], MeasuredError> {
        let end = offset.checked_add(count);
        end.and_then(|end| self.bytes.get(offset..end)).ok_or_else(|| self.ends(field, offset, count))
    }

    fn array<const N: usize>(&self, field: &str, offset: usize) -> Result<[u8; N], MeasuredError> {
        let mut array = [0; N];
        array.copy_from_slice(self.slice(field, offset, N)?);
        if self.order == ByteOrder::Big {
            array.reverse();
        }
        Ok(array)
    }

    pub(super) fn u16(&self, field: &str, offset: usize) -> Result<u16, MeasuredError> {
        self.array(field, offset).map(u16::from_le_bytes)
    }

    pub(super) fn i16(&self, field: &str, offset: usize) -> Result<i16, MeasuredError> {
        self.array(field, offset).map(i16::from_le_bytes)
    }

    pub(super) fn i32(&self, field: &str, offset: usize) -> Result<i32, MeasuredError> {
        self.array(field, offset).map(i32::from_le_bytes)
    }

    pub(super) fn f32(&self, field: &str, offset: usize) -> Result<f64, MeasuredError> {
        self.array(field, offset).map(f32::from_le_bytes).map(f64::from)
    }

    /// A whole number above zero.
    pub(super) fn count16(&self, field: &str, offset: usize) -> Result<usize, MeasuredError> {
        match self.u16(field, offset)? {
            0 => Err(self.wrong(field, offset, 0, "it must be 1 or more")),
            count => Ok(count.into()),
        }
    }

    /// Text up to the first zero, without blanks around it.
    pub(super) fn text(&self, field: &str, offset: usize, count: usize) -> Result<String, MeasuredError> {
        let bytes = self.slice(field, offset, count)?;
        let bytes = bytes.split(|&byte| byte == 0).next().unwrap_or_default();
        Ok(plain(bytes))
    }

    /// Samples one after another, each written behind the other into `into`.
    pub(super) fn samples(
        &self,
        field: &str,
        offset: usize,
        count: usize,
        kind: SampleKind,
        into: &mut Vec<f64>,
    ) -> Result<(), MeasuredError> {
        let width = kind.bytes();
        let bytes = match count.checked_mul(width) {
            Some(needed) => self.slice(field, offset, needed)?,
            None => return Err(self.ends(field, offset, usize::MAX)),
        };
        let big = self.order == ByteOrder::Big;
        for (index, raw) in bytes.chunks_exact(width).enumerate() {
            let mut four = [0; 4];
            four[..width].copy_from_slice(raw);
            if big {
                four[..width].reverse();
            }
            let word = u32::from_le_bytes(four);
            let value = match kind {
                SampleKind::Unsigned8 => f64::from(four[0]) - 128.0,
                SampleKind::Unsigned16 => f64::from(word) - 32768.0,
                SampleKind::Signed16 => f64::from(i16::from_le_bytes([four[0], four[1]])),
                SampleKind::Signed32 => f64::from(word.cast_signed()),
                SampleKind::Float32 => f64::from(f32::from_bits(word)),
                SampleKind::Ibm32 => ibm(word),
            };
            if !value.is_finite() {
                let place = offset + index * width;
                return Err(self.wrong(&format!("{field}, sample {index}"), place, value, "it must be finite"));
            }
            into.push(value);
        }
        Ok(())
    }

    /// The error of a field that cannot be right.
    pub(super) fn wrong(
        &self,
        field: &str,
        offset: usize,
        value: impl ToString,
        limit: impl Into<String>,
    ) -> MeasuredError {
        let (path, offset, value) = (self.path.into(), offset as u64, value.to_string());
        MeasuredError::Value { path, field: field.into(), offset, value, limit: limit.into() }
    }

    /// The error of a file that ends too early.
    pub(super) fn ends(&self, field: &str, offset: usize, needed: usize) -> MeasuredError {
        MeasuredError::Ends {
            path: self.path.into(),
            field: field.into(),
            offset: offset as u64,
            needed: needed as u64,
            size: self.bytes.len() as u64,
        }
    }
}

/// Bytes as text, without blanks around it; what cannot be shown is a question mark.
pub(super) fn plain(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let shown = |c: char| match c {
        '\t' => ' ',
        '\u{fffd}' => '?',
        c if c.is_control() => '?',
        c => c,
    };
    text.trim().chars().map(shown).collect()
}

/// IBM System/360 single precision: `(-1)^sign * 0.fraction * 16^(exponent - 64)`.
fn ibm(word: u32) -> f64 {
    let fraction = f64::from(word & 0x00ff_ffff) / f64::from(1 << 24);
    let exponent = (word >> 24 & 0x7f).cast_signed() - 64;
    let size = fraction * 16f64.powi(exponent);
    if word >> 31 == 1 { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// -118.625 is C276A000 and 1 is 41100000 in the System/360 *Principles of Operation*; the largest is 7.2370051e75.
    #[test]
    fn ibm_floats_are_those_of_the_manual() {
        assert_eq!(ibm(0xc276_a000), -118.625);
        assert_eq!(ibm(0x4110_0000), 1.0);
        assert_eq!(ibm(0), 0.0);
        assert!((ibm(0x7fff_ffff) / 7.237_005_1e75 - 1.0).abs() < 1e-7);
    }

    #[test]
    fn both_byte_orders_and_every_kind() {
        let read = |order, kind: SampleKind, bytes: &[u8]| {
            let mut into = vec![];
            let there = Bytes { path: Path::new("x"), bytes, order };
            there.samples("trace 0", 0, bytes.len() / kind.bytes(), kind, &mut into).map(|()| into)
        };
        let (little, big) = (ByteOrder::Little, ByteOrder::Big);
        assert_eq!(read(little, SampleKind::Unsigned8, &[0, 128, 255]).unwrap(), [-128.0, 0.0, 127.0]);
        assert_eq!(read(little, SampleKind::Unsigned16, &[0, 0x80, 1, 0]).unwrap(), [0.0, -32767.0]);
        assert_eq!(read(big, SampleKind::Signed16, &[0xff, 0xfe]).unwrap(), [-2.0]);
        assert_eq!(read(little, SampleKind::Signed32, &[0xff; 4]).unwrap(), [-1.0]);
        assert_eq!(read(big, SampleKind::Float32, &1.5f32.to_be_bytes()).unwrap(), [1.5]);
        assert_eq!(
            read(big, SampleKind::Float32, &[1.0f32, f32::NAN].map(f32::to_be_bytes).concat()).unwrap_err().to_string(),
            "`x`: `trace 0, sample 1` at byte 4 is NaN: it must be finite"
        );
    }

    #[test]
    fn what_lies_beyond_the_end_is_named() {
        let bytes = Bytes::little(Path::new("a.dzt"), &[1, 2, 3]);
        assert_eq!(bytes.u16("rh_tag", 0).unwrap(), 0x201);
        assert_eq!(
            bytes.u16("rh_data", 2).unwrap_err().to_string(),
            "`a.dzt` ends too early: `rh_data` at byte 2 needs 2 bytes, the file has 3"
        );
        let mut into = vec![];
        assert!(bytes.samples("trace", usize::MAX, 4, SampleKind::Signed16, &mut into).is_err());
        assert!(bytes.samples("trace", 0, usize::MAX, SampleKind::Signed16, &mut into).is_err());
        assert_eq!(into.capacity(), 0);
    }
}
