//! NumPy's `.npz`: a ZIP archive of stored (not compressed) `.npy` files.

/// An array of 64-bit floats to store.
pub(super) struct Array<'a> {
    pub(super) name: &'a str,
    /// Lengths, the slowest index first.
    pub(super) shape: Vec<usize>,
    pub(super) values: &'a [f64],
}

/// The bytes of an archive, or nothing where it would have more than the 4 GiB that the format can count.
pub(super) fn archive(arrays: &[Array<'_>]) -> Option<Vec<u8>> {
    let mut bytes = vec![];
    let mut directory = vec![];
    for array in arrays {
        let (content, name) = (npy(array), format!("{}.npy", array.name));
        let offset = u32::try_from(bytes.len()).ok()?;
        let size = u32::try_from(content.len()).ok()?;
        let sum = crc32fast::hash(&content);
        // Version 2.0, no flags, stored, 1 January 1980, check sum, both sizes, length of the name, nothing further
        // (PKWARE, APPNOTE.TXT 6.3.10, 4.3.7).
        let mut about = vec![20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0];
        [sum, size, size].iter().for_each(|word| about.extend(word.to_le_bytes()));
        about.extend((name.len() as u16).to_le_bytes());
        about.extend([0, 0]);
        bytes.extend(b"PK\x03\x04");
        bytes.extend(&about);
        bytes.extend(name.as_bytes());
        bytes.extend(content);
        // The same again in the directory, behind the version that made it (4.3.12).
        directory.extend(b"PK\x01\x02\x14\x00");
        directory.extend(&about);
        directory.extend([0; 10]);
        directory.extend(offset.to_le_bytes());
        directory.extend(name.as_bytes());
    }
    let (start, size) = (u32::try_from(bytes.len()).ok()?, directory.len() as u32);
    let count = (arrays.len() as u16).to_le_bytes();
    bytes.extend(directory);
    bytes.extend(b"PK\x05\x06\0\0\0\0");
    bytes.extend([count, count].concat());
    bytes.extend([size.to_le_bytes(), start.to_le_bytes()].concat());
    bytes.extend([0, 0]);
    Some(bytes)
}

/// The bytes of a `.npy` file, version 1.0: a Python literal, padded so that the values begin at a multiple of 64.
fn npy(array: &Array<'_>) -> Vec<u8> {
    let shape: String = array.shape.iter().map(|length| format!("{length}, ")).collect();
    let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}");
    while !(header.len() + 11).is_multiple_of(64) {
        header.push(' ');
    }
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(array.values.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_begin_at_a_multiple_of_64_and_the_directory_names_every_array() {
        let array = Array { name: "samples", shape: vec![1, 2], values: &[1.0, -2.0] };
        let bytes = npy(&array);
        assert_eq!((bytes.len() - 16) % 64, 0);
        assert_eq!(bytes[bytes.len() - 8..], (-2.0f64).to_le_bytes());
        let all = archive(&[array, Array { name: "time", shape: vec![1], values: &[0.5] }]).unwrap();
        assert_eq!(all[..4], *b"PK\x03\x04");
        assert_eq!(all.windows(4).filter(|four| four == b"PK\x01\x02").count(), 2);
        let end = &all[all.len() - 22..];
        assert_eq!((&end[..4], end[10]), (&b"PK\x05\x06"[..], 2));
        let start = u32::from_le_bytes([end[16], end[17], end[18], end[19]]) as usize;
        assert_eq!(all[start..start + 4], *b"PK\x01\x02");
    }
}
