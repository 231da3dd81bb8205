//! Mutations: of texts by words and lines, of files by bytes and numbers.

use rand::RngExt as _;
use rand_pcg::Pcg64;

/// Numbers that readers stumble over.
const NUMBERS: [&str; 62] = [
    "0",
    "-0",
    "0.0",
    "1",
    "2",
    "3",
    "-1",
    "1.5",
    "0.5",
    "0.002",
    "0.001",
    "1e-3",
    "0.02",
    "1e-9",
    "1e-12",
    "1e-30",
    "1e-300",
    "5e-324",
    "1e-320",
    "1e3",
    "1e6",
    "1e9",
    "1e12",
    "1e18",
    "1e19",
    "1e30",
    "1e300",
    "1e308",
    "1.7976931348623157e308",
    "1e309",
    "-1e309",
    "inf",
    "-inf",
    "nan",
    "NaN",
    "Infinity",
    "127",
    "128",
    "255",
    "256",
    "32767",
    "32768",
    "65535",
    "65536",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "9223372036854775807",
    "9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "-9223372036854775808",
    "1000000",
    "1000000000",
    "99999999999999999999999",
    "0x10",
    "1_000",
    "1,5",
    "+1",
    ".5",
    "5.",
];

/// Whole numbers that a length or an offset may be replaced by.
const LENGTHS: [u64; 18] = [
    0,
    1,
    2,
    7,
    8,
    0x7f,
    0xff,
    0x100,
    0x7fff,
    0xffff,
    0x10000,
    0x7fff_ffff,
    0xffff_ffff,
    0x1_0000_0000,
    1 << 40,
    1 << 62,
    u64::MAX / 2,
    u64::MAX,
];

/// Any of some.
pub fn one<'a, T: ?Sized>(random: &mut Pcg64, of: &[&'a T]) -> &'a T {
    of[random.random_range(0..of.len())]
}

/// A number as text: one that readers stumble over, or one that a small scene might hold.
pub fn number(random: &mut Pcg64) -> String {
    match random.random_range(0..6) {
        0..3 => one(random, &NUMBERS).to_owned(),
        3 => format!("{}", random.random_range(-3..40)),
        4 => format!("{:.3}", random.random_range(0.0..0.06)),
        _ => format!("{:e}", 10f64.powf(random.random_range(-320.0..309.0))),
    }
}

/// Mutates a text of lines and words. `words` are those that the format knows, `line` makes a new line.
pub fn text(
    original: &[u8],
    other: &[u8],
    words: &[&str],
    line: &dyn Fn(&mut Pcg64) -> String,
    random: &mut Pcg64,
) -> Vec<u8> {
    let original = String::from_utf8_lossy(original);
    let other = String::from_utf8_lossy(other);
    let mut lines: Vec<String> = original.lines().map(Into::into).collect();
    let strange: Vec<&str> = other.lines().collect();
    // Mostly one or two changes: a text with many is refused at its first wrong line.
    let changes = 1 + (-2.0 * random.random_range(1e-9..1.0f64).ln()) as usize;
    for _ in 0..changes {
        if lines.is_empty() {
            lines.push(line(random));
        }
        let at = random.random_range(0..lines.len());
        match random.random_range(0..30) {
            0..10 => lines[at] = with_word(&lines[at], random, |random, _| Some(number(random))),
            10..13 => lines[at] = with_word(&lines[at], random, |random, _| Some(one(random, words).into())),
            13 => lines[at] = with_word(&lines[at], random, |_, _| None),
            14 => lines[at] = with_word(&lines[at], random, |_, word| Some(format!("{word} {word}"))),
            15 => {
                // Two words change places.
                let from = random.random_range(0..lines.len());
                let word = any_word(&lines[from], random);
                lines[at] = with_word(&lines[at], random, |_, _| Some(word.clone()));
            }
            16 => {
                let copy = lines[at].clone();
                lines.insert(random.random_range(0..=lines.len()), copy);
            }
            17 => {
                lines.remove(at);
            }
            18 => {
                let with = random.random_range(0..lines.len());
                lines.swap(at, with);
            }
            19 => lines[at] = cut(&lines[at], random),
            20 => {
                let few = random.random_range(2..60);
                let copy = lines[at].clone();
                lines.splice(at..at, vec![copy; few]);
            }
            21 if !strange.is_empty() => {
                let from = random.random_range(0..strange.len());
                lines.insert(at, strange[from].into());
            }
            22 => {
                let few = random.random_range(2..400);
                lines[at] = with_word(&lines[at], random, |_, word| Some(vec![word; few].join(" ")));
            }
            23 => lines[at] = with_word(&lines[at], random, |random, word| Some(changed(word, random))),
            24 => lines[at] = changed(&lines[at], random),
            25 => lines.truncate(at),
            _ => lines.insert(random.random_range(0..=lines.len()), line(random)),
        }
        if lines.len() > 2000 {
            break;
        }
    }
    let mut bytes = lines.join(if random.random_bool(0.02) { "\r\n" } else { "\n" }).into_bytes();
    bytes.push(b'\n');
    match random.random_range(0..40) {
        0 => flip(&mut bytes, random),
        1 => bytes.truncate(random.random_range(0..=bytes.len())),
        _ => {}
    }
    bytes.truncate(1 << 16);
    bytes
}

/// Mutates a file of bytes: mostly its first part and what lies around signatures, where the structure is.
pub fn bytes(original: &[u8], random: &mut Pcg64) -> Vec<u8> {
    let mut bytes = original.to_vec();
    let signatures = signatures(original);
    let changes = 1 + (-2.0 * random.random_range(1e-9..1.0f64).ln()) as usize;
    for _ in 0..changes {
        if bytes.len() < 16 {
            break;
        }
        let place = match random.random_range(0..4) {
            0 => random.random_range(0..bytes.len()),
            1 => random.random_range(0..bytes.len().min(4096)),
            _ if signatures.is_empty() => random.random_range(0..bytes.len().min(512)),
            _ => (signatures[random.random_range(0..signatures.len())] + random.random_range(0..160))
                .min(bytes.len() - 1),
        };
        match random.random_range(0..24) {
            0..6 => bytes[place] = random.random(),
            6..9 => bytes[place] ^= 1 << random.random_range(0..8),
            9..16 => {
                // A length or an offset, of 1 to 8 bytes, little-endian.
                let width = 1 << random.random_range(0..4);
                let place = if random.random_bool(0.7) { place & !(width - 1) } else { place };
                let value = match random.random_range(0..3) {
                    0 => random.random_range(0..2 * bytes.len() as u64),
                    _ => LENGTHS[random.random_range(0..LENGTHS.len())],
                };
                for (byte, new) in bytes[place..].iter_mut().zip(&value.to_le_bytes()[..width]) {
                    *byte = *new;
                }
            }
            16..18 => bytes.truncate(place),
            18..20 => {
                let (from, length) = (random.random_range(0..bytes.len()), random.random_range(1..128));
                let piece: Vec<u8> = bytes[from..].iter().take(length).copied().collect();
                bytes.splice(place..(place + piece.len()).min(bytes.len()), piece);
            }
            20..22 => bytes.iter_mut().skip(place).take(random.random_range(1..64)).for_each(|byte| *byte = 0),
            22 => drop(bytes.drain(place..(place + random.random_range(1..32)).min(bytes.len()))),
            _ => bytes[place] = bytes[place].wrapping_add(random.random_range(0..5)).wrapping_sub(2),
        }
    }
    bytes
}

/// Where the parts of an HDF5 file begin.
fn signatures(bytes: &[u8]) -> Vec<usize> {
    const KNOWN: [&[u8]; 8] = [b"TREE", b"HEAP", b"SNOD", b"GCOL", b"OHDR", b"OCHK", b"FRHP", b"BTHD"];
    let mut found: Vec<usize> =
        (0..bytes.len().saturating_sub(4)).filter(|&k| KNOWN.contains(&&bytes[k..k + 4])).collect();
    // Headers of version 1 have no signature: version 1, a zero, then a small count of messages.
    found.extend((0..bytes.len().saturating_sub(16)).step_by(8).filter(|&k| {
        bytes[k] == 1 && bytes[k + 1] == 0 && (1..40).contains(&bytes[k + 2]) && bytes[k + 3] == 0 && bytes[k + 4] == 1
    }));
    found
}

fn flip(bytes: &mut [u8], random: &mut Pcg64) {
    if !bytes.is_empty() {
        let at = random.random_range(0..bytes.len());
        bytes[at] = random.random();
    }
}

fn any_word(line: &str, random: &mut Pcg64) -> String {
    let words: Vec<&str> = line.split_whitespace().collect();
    if words.is_empty() { String::new() } else { one(random, &words).into() }
}

/// Replaces one word: those between blanks, commas, quotes, brackets and equals signs.
fn with_word(line: &str, random: &mut Pcg64, change: impl FnOnce(&mut Pcg64, &str) -> Option<String>) -> String {
    let border = |c: char| c.is_whitespace() || ",;=\"[]{}".contains(c);
    let words: Vec<(usize, usize)> = line
        .split(border)
        .filter(|word| !word.is_empty())
        .map(|word| (word.as_ptr() as usize - line.as_ptr() as usize, word.len()))
        .collect();
    if words.is_empty() {
        return line.into();
    }
    // The first word, the command, less often than the others.
    let mut at = random.random_range(0..words.len());
    if at == 0 && random.random_bool(0.7) {
        at = words.len() - 1;
    }
    let (start, length) = words[at];
    let word = change(random, &line[start..start + length]).unwrap_or_default();
    format!("{}{word}{}", &line[..start], &line[start + length..])
}

fn cut(line: &str, random: &mut Pcg64) -> String {
    let count = line.chars().count();
    line.chars().take(random.random_range(0..=count)).collect()
}

fn changed(text: &str, random: &mut Pcg64) -> String {
    let mut chars: Vec<char> = text.chars().collect();
    let at = random.random_range(0..=chars.len());
    let new = *one(
        random,
        &[&'#', &':', &' ', &'-', &'e', &'.', &'0', &'9', &'\t', &'é', &'\u{feff}', &'\0', &'\u{2028}', &'+'],
    );
    if at < chars.len() && random.random_bool(0.5) {
        chars[at] = new
    } else {
        chars.insert(at, new)
    }
    chars.into_iter().collect()
}
