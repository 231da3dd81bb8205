//! Numbers on their way to or from a file, through one and the same description of what there is.

use std::io::{self, Read, Write};

use super::vector::Four;

/// Takes numbers to a file, or brings them from it.
pub trait Tape {
    /// Passes eight bytes.
    fn eight(&mut self, bytes: &mut [u8; 8]) -> io::Result<()>;
    /// Passes the length of a list.
    fn len(&mut self, len: usize) -> io::Result<usize> {
        let mut bytes = (len as u64).to_le_bytes();
        self.eight(&mut bytes)?;
        Ok(u64::from_le_bytes(bytes) as usize)
    }

    /// Passes a number, all its bits.
    fn number(&mut self, number: &mut f64) -> io::Result<()> {
        let mut bytes = number.to_le_bytes();
        self.eight(&mut bytes)?;
        *number = f64::from_le_bytes(bytes);
        Ok(())
    }

    /// Passes numbers.
    fn numbers(&mut self, numbers: &mut [f64]) -> io::Result<()> {
        numbers.iter_mut().try_for_each(|number| self.number(number))
    }

    /// Passes a count.
    fn count(&mut self, count: &mut u64) -> io::Result<()> {
        let mut bytes = count.to_le_bytes();
        self.eight(&mut bytes)?;
        *count = u64::from_le_bytes(bytes);
        Ok(())
    }

    /// Passes an index.
    fn index(&mut self, index: &mut usize) -> io::Result<()> {
        *index = self.len(*index)?;
        Ok(())
    }

    /// Passes a list of indices.
    fn indices(&mut self, indices: &mut Vec<u32>) -> io::Result<()> {
        let len = self.len(indices.len())?;
        // Grows as it is read, so that a damaged length ends with the file and not with the memory.
        for n in 0..len {
            if indices.len() == n {
                indices.push(0);
            }
            let mut count = u64::from(indices[n]);
            self.count(&mut count)?;
            indices[n] = u32::try_from(count).map_err(|_| io::Error::from(io::ErrorKind::InvalidData))?;
        }
        Ok(())
    }

    /// Passes a list of small numbers.
    fn bytes(&mut self, bytes: &mut Vec<u8>) -> io::Result<()> {
        let mut wide: Vec<u32> = bytes.iter().map(|&byte| u32::from(byte)).collect();
        self.indices(&mut wide)?;
        *bytes = wide.into_iter().map(|wide| wide as u8).collect();
        Ok(())
    }

    /// Passes a list of fours.
    fn fours(&mut self, fours: &mut Vec<Four>) -> io::Result<()> {
        let len = self.len(fours.len())?;
        for n in 0..len {
            if fours.len() == n {
                fours.push(Four::default());
            }
            self.numbers(&mut fours[n].0)?;
        }
        Ok(())
    }
}

/// A checksum that a flipped bit, or numbers that have changed places, show in: FNV-1a, eight bytes at a time.
#[derive(Debug, Clone, Copy)]
struct Checksum(u64);

impl Checksum {
    const NEW: Self = Self(0xcbf2_9ce4_8422_2325);

    fn add(&mut self, bytes: [u8; 8]) {
        self.0 = (self.0 ^ u64::from_le_bytes(bytes)).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(23);
    }
}

/// Writes.
pub struct Writer<'a> {
    file: &'a mut dyn Write,
    sum: Checksum,
}

impl<'a> Writer<'a> {
    /// Begins.
    pub fn new(file: &'a mut dyn Write) -> Self {
        Self { file, sum: Checksum::NEW }
    }

    /// Ends with the checksum.
    pub fn finish(self) -> io::Result<()> {
        self.file.write_all(&self.sum.0.to_le_bytes())
    }
}

impl Tape for Writer<'_> {
    fn eight(&mut self, bytes: &mut [u8; 8]) -> io::Result<()> {
        self.sum.add(*bytes);
        self.file.write_all(bytes)
    }
}

/// Reads.
pub struct Reader<'a> {
    file: &'a mut dyn Read,
    sum: Checksum,
}

impl<'a> Reader<'a> {
    /// Begins.
    pub fn new(file: &'a mut dyn Read) -> Self {
        Self { file, sum: Checksum::NEW }
    }

    /// Makes sure that the checksum is right and nothing follows.
    pub fn finish(self) -> io::Result<()> {
        let mut bytes = [0; 8];
        self.file.read_exact(&mut bytes)?;
        if u64::from_le_bytes(bytes) != self.sum.0 {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "its checksum is wrong"));
        }
        if self.file.read(&mut [0])? > 0 {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "there is more in it than there should be"));
        }
        Ok(())
    }
}

impl Tape for Reader<'_> {
    fn eight(&mut self, bytes: &mut [u8; 8]) -> io::Result<()> {
        self.file.read_exact(bytes)?;
        self.sum.add(*bytes);
        Ok(())
    }
}
