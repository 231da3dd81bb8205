//! Pixels and how they are packed: PNG, and base64 for the inside of an SVG file.

use super::error::PlotError;

/// A picture, 3 bytes (red, green, blue) per pixel, row by row from the top.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Image {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// `3 * width * height` bytes.
    pub pixels: Vec<u8>,
}

impl Image {
    /// The pixel at column `x` and row `y`, or white outside the picture.
    fn pixel(&self, x: usize, y: usize) -> [u8; 3] {
        let at = 3 * (y * self.width + x);
        match self.pixels.get(at..at + 3) {
            Some(&[r, g, b]) => [r, g, b],
            _ => [255; 3],
        }
    }

    /// The picture stretched to another size: each pixel takes the nearest one.
    pub(super) fn stretched(&self, width: usize, height: usize) -> Self {
        let columns: Vec<usize> = (0..width).map(|x| x * self.width / width.max(1)).collect();
        let mut pixels = Vec::with_capacity(3 * width * height);
        for y in 0..height {
            let row = y * self.height / height.max(1);
            for &column in &columns {
                pixels.extend(self.pixel(column, row));
            }
        }
        Self { width, height, pixels }
    }

    /// The picture with every pixel repeated, so that a viewer that blurs pictures blurs a small part of each.
    pub(super) fn enlarged(&self) -> Self {
        let times = (1600 / self.width.max(self.height).max(1)).clamp(1, 64);
        self.stretched(self.width * times, self.height * times)
    }

    /// The picture at half the size: each pixel is the mean of four. An odd last row or column is left out.
    pub(super) fn halved(&self) -> Self {
        let (width, height) = (self.width / 2, self.height / 2);
        let mut pixels = Vec::with_capacity(3 * width * height);
        for rows in self.pixels.chunks_exact(2 * 3 * self.width.max(1)).take(height) {
            let (upper, lower) = rows.split_at(3 * self.width);
            for (a, b) in upper.chunks_exact(6).zip(lower.chunks_exact(6)) {
                for c in 0..3 {
                    let sum = u16::from(a[c]) + u16::from(a[c + 3]) + u16::from(b[c]) + u16::from(b[c + 3]);
                    pixels.push(((sum + 2) / 4) as u8);
                }
            }
        }
        Self { width, height, pixels }
    }

    /// Packs the picture as PNG.
    pub(super) fn png(&self) -> Result<Vec<u8>, PlotError> {
        let (width, height) = (self.width as u32, self.height as u32);
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Balanced);
        let pack = |encoder: png::Encoder<'_, &mut Vec<u8>>| {
            let mut writer = encoder.write_header()?;
            writer.write_image_data(&self.pixels)?;
            writer.finish()
        };
        pack(encoder).map_err(|source| PlotError::Png { width, height, source })?;
        Ok(bytes)
    }
}

/// Writes bytes in base64 with padding (RFC 4648, section 4).
pub fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for group in bytes.chunks(3) {
        let byte = |i: usize| u32::from(group.get(i).copied().unwrap_or(0));
        let bits = byte(0) << 16 | byte(1) << 8 | byte(2);
        for i in 0..4 {
            let letter = LETTERS[(bits >> (18 - 6 * i) & 63) as usize];
            text.push(if i <= group.len() { char::from(letter) } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The test vectors of RFC 4648, section 10.
    #[test]
    fn base64_is_that_of_the_rfc() {
        let vectors = [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foob", "Zm9vYg==")];
        for (plain, coded) in vectors.into_iter().chain([("fooba", "Zm9vYmE="), ("foobar", "Zm9vYmFy")]) {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
        assert_eq!(base64(&[0xfb, 0xff]), "+/8=");
    }

    #[test]
    fn half_a_picture_is_the_mean_of_four_pixels() {
        let image = Image { width: 2, height: 2, pixels: vec![0, 0, 0, 255, 0, 10, 255, 0, 20, 254, 4, 30] };
        assert_eq!(image.halved().pixels, [191, 1, 15]);
        let stretched = image.stretched(4, 2);
        assert_eq!(stretched.pixels[..12], [0, 0, 0, 0, 0, 0, 255, 0, 10, 255, 0, 10]);
    }
}
