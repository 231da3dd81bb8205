//! The text at the beginning of a SEG-Y file: 40 lines of 80 characters, in EBCDIC by the standard, in ASCII by habit.

use super::cursor::plain;

/// Bytes of the text.
pub(super) const TEXT: usize = 3200;
/// Characters of a line.
const LINE: usize = 80;

/// The lines of a header, in whichever code it is.
pub(super) fn lines(bytes: &[u8]) -> Vec<String> {
    let header = &bytes[..bytes.len().min(TEXT)];
    // A blank is 0x40 in EBCDIC and 0x20 in ASCII, and a header is mostly blanks.
    let count = |byte: u8| header.iter().filter(|&&b| b == byte).count();
    let is_ebcdic = count(0x40) > count(0x20);
    let line = |line: &[u8]| {
        let ascii: Vec<u8> = if is_ebcdic { line.iter().map(|&byte| from_ebcdic(byte)).collect() } else { line.into() };
        let bytes: Vec<u8> = ascii.into_iter().map(|byte| if byte == 0 { b' ' } else { byte }).collect();
        plain(&bytes)
    };
    header.chunks(LINE).map(line).collect()
}

/// A header in EBCDIC of up to 40 lines, each behind its number; what is too long is cut, what has no code is a blank.
pub(super) fn header(lines: &[String]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(TEXT);
    for number in 0..TEXT / LINE {
        let text = lines.get(number).map_or("", String::as_str);
        let line = format!("C{:<2} {text}", number + 1);
        bytes.extend(line.chars().map(to_ebcdic).chain(std::iter::repeat(to_ebcdic(' '))).take(LINE));
    }
    bytes
}

/// The letters, digits and some signs of code page 037; all else is a blank.
fn from_ebcdic(byte: u8) -> u8 {
    match byte {
        0x81..=0x89 => byte - 0x81 + b'a',
        0x91..=0x99 => byte - 0x91 + b'j',
        0xa2..=0xa9 => byte - 0xa2 + b's',
        0xc1..=0xc9 => byte - 0xc1 + b'A',
        0xd1..=0xd9 => byte - 0xd1 + b'J',
        0xe2..=0xe9 => byte - 0xe2 + b'S',
        0xf0..=0xf9 => byte - 0xf0 + b'0',
        0x4b => b'.',
        0x4d => b'(',
        0x5d => b')',
        0x4e => b'+',
        0x60 => b'-',
        0x61 => b'/',
        0x6b => b',',
        0x6d => b'_',
        0x7a => b':',
        0x7e => b'=',
        _ => b' ',
    }
}

fn to_ebcdic(letter: char) -> u8 {
    let code = (0..=u8::MAX).find(|&code| from_ebcdic(code) != b' ' && char::from(from_ebcdic(code)) == letter);
    code.unwrap_or(0x40)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_come_back_from_either_code() {
        let text = ["Made by ballast-gpr 0.1", "one count is 1.5E-3 V/m (a, b): x=+1_2", "{odd} ö"].map(String::from);
        let bytes = header(&text);
        assert_eq!(bytes.len(), TEXT);
        // C1 in code page 037.
        assert_eq!(bytes[..2], [0xc3, 0xf1]);
        assert_eq!(
            lines(&bytes)[..3],
            ["C1  Made by ballast-gpr 0.1", "C2  one count is 1.5E-3 V/m (a, b): x=+1_2", "C3   odd"]
        );
        let ascii = format!("{:<80}{:<80}", "C 1 CLIENT", "C 2 LINE");
        assert_eq!(lines(ascii.as_bytes()), ["C 1 CLIENT", "C 2 LINE"]);
    }
}
