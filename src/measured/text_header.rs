//! Headers of text: one field a line, `KEY = value` or `KEY:value`.

use std::path::Path;

use super::cursor::plain;
use super::error::MeasuredError;

/// A header is a page of text; what is larger is some other file.
const MOST_BYTES: usize = 1 << 20;

/// One field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) key: String,
    pub(super) value: String,
    /// Where the value begins, from zero.
    pub(super) offset: usize,
}

/// The fields of a header.
#[derive(Debug, Clone)]
pub(super) struct TextHeader<'a> {
    path: &'a Path,
    size: usize,
    fields: Vec<Field>,
}

impl<'a> TextHeader<'a> {
    /// Reads the fields: the key ends at the first `separator` of a line; lines without one are left out.
    pub(super) fn read(path: &'a Path, bytes: &[u8], separator: u8) -> Result<Self, MeasuredError> {
        if bytes.len() > MOST_BYTES {
            return Err(MeasuredError::Value {
                path: path.into(),
                field: "header".into(),
                offset: 0,
                value: format!("{} bytes long", bytes.len()),
                limit: format!("a header has at most {MOST_BYTES}"),
            });
        }
        let mut fields = vec![];
        let mut start = 0;
        for line in bytes.split(|&byte| byte == b'\n') {
            if let Some(at) = line.iter().position(|&byte| byte == separator) {
                let value = &line[at + 1..];
                let blanks = value.iter().take_while(|byte| byte.is_ascii_whitespace()).count();
                let key = plain(&line[..at]).to_ascii_uppercase();
                fields.push(Field { key, value: plain(value), offset: start + at + 1 + blanks });
            }
            start += line.len() + 1;
        }
        Ok(Self { path, size: bytes.len(), fields })
    }

    /// The first field of this name that holds something.
    pub(super) fn get(&self, key: &str) -> Option<&Field> {
        self.fields.iter().find(|field| field.key == key && !field.value.is_empty())
    }

    /// The value of a field, if it is there.
    pub(super) fn text(&self, key: &str) -> Option<String> {
        self.get(key).map(|field| field.value.clone())
    }

    /// All fields, as they stand there.
    pub(super) fn all(&self) -> Vec<(String, String)> {
        self.fields.iter().map(|field| (field.key.clone(), field.value.clone())).collect()
    }

    /// A field that must be there.
    pub(super) fn needed(&self, key: &'static str) -> Result<&Field, MeasuredError> {
        self.get(key).ok_or_else(|| self.missing(key))
    }

    /// The error of a field that is not there.
    pub(super) fn missing(&self, field: &'static str) -> MeasuredError {
        MeasuredError::NoField { path: self.path.into(), field, size: self.size as u64 }
    }

    /// A finite number, if the field is there.
    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, MeasuredError> {
        let Some(field) = self.get(key) else { return Ok(None) };
        // A decimal comma is written by some systems.
        let number = field.value.replace(',', ".").parse::<f64>().ok().filter(|value| value.is_finite());
        number.map(Some).ok_or_else(|| self.wrong(field, "it must be a number"))
    }

    /// A whole number above zero that must be there.
    pub(super) fn count(&self, key: &'static str) -> Result<usize, MeasuredError> {
        let field = self.needed(key)?;
        let count = field.value.parse::<u32>().ok().filter(|count| *count > 0);
        count.map(|count| count as usize).ok_or_else(|| self.wrong(field, "it must be a whole number of 1 or more"))
    }

    /// A whole number, if the field is there.
    pub(super) fn whole(&self, key: &str) -> Result<Option<u64>, MeasuredError> {
        let Some(field) = self.get(key) else { return Ok(None) };
        let whole = field.value.parse::<u64>().ok();
        whole.map(Some).ok_or_else(|| self.wrong(field, "it must be a whole number of 0 or more"))
    }

    /// The error of a field that cannot be right.
    pub(super) fn wrong(&self, field: &Field, limit: impl Into<String>) -> MeasuredError {
        MeasuredError::Value {
            path: self.path.into(),
            field: field.key.clone(),
            offset: field.offset as u64,
            value: format!("`{}`", field.value.chars().take(40).collect::<String>()),
            limit: limit.into(),
        }
    }

    /// Where the value of a field begins; the end of the header where it is missing.
    pub(super) fn offset(&self, key: &str) -> u64 {
        self.get(key).map_or(self.size, |field| field.offset) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_found_with_their_places() {
        let text = b"1234\r\nNUMBER OF TRACES   = 531 \r\nA=\r\nrange = 1,5\nbad = x1\n";
        let header = TextHeader::read(Path::new("a.hd"), text, b'=').unwrap();
        assert_eq!(header.count("NUMBER OF TRACES").unwrap(), 531);
        assert_eq!(header.offset("NUMBER OF TRACES"), 27);
        assert_eq!(&text[27..30], b"531");
        assert_eq!(header.number("RANGE").unwrap(), Some(1.5));
        assert_eq!(header.number("A").unwrap(), None);
        assert_eq!(
            header.number("BAD").unwrap_err().to_string(),
            "`a.hd`: `BAD` at byte 55 is `x1`: it must be a number"
        );
        assert_eq!(header.count("A").unwrap_err().to_string(), "`a.hd` has no field `A` in its 58 bytes");
    }
}
