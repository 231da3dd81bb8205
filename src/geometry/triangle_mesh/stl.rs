//! STL: text and binary, read and written.

use std::fmt::Write as _;

use super::error::MeshError;
use super::mesh::TriangleMesh;
use super::vector::{V3, cross, sub, unit};

/// Bytes before the triangles of a binary file: a comment and a count.
const HEADER: usize = 84;
/// Bytes of a triangle: normal, three corners, and two bytes without meaning.
const RECORD: usize = 50;

impl TriangleMesh {
    /// Reads an STL file of either kind, in metres; points at the same place become one, and each `solid` of a text file a patch
    /// of its name. The stored normals are not used: the order of the corners tells the outside.
    ///
    /// # Errors
    /// When the bytes are no STL file; whatever [`TriangleMesh::new`] finds.
    pub fn from_stl(bytes: &[u8]) -> Result<Self, MeshError> {
        // Binary files may begin with the word of text files; their length tells them.
        let count = bytes.get(80..HEADER).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
        if let Some(count) = count
            && bytes.len() as u64 == HEADER as u64 + RECORD as u64 * u64::from(count)
        {
            return Self::from_soup(&binary_corners(&bytes[HEADER..]));
        }
        if bytes.trim_ascii_start().starts_with(b"solid") {
            return from_text(&String::from_utf8_lossy(bytes));
        }
        let end = MeshError::Stl { what: "the end of the file", place: format!("byte {}", bytes.len()) };
        Err(if bytes.len() < HEADER || count.is_some() { end } else { MeshError::Empty })
    }

    /// Writes the mesh as binary STL: 32-bit coordinates, without patches.
    pub fn to_stl_binary(&self) -> Vec<u8> {
        let mut bytes = vec![b' '; 80];
        bytes[..13].copy_from_slice(b"triangle mesh");
        bytes.extend((self.triangles().len() as u32).to_le_bytes());
        for triangle in 0..self.triangles().len() {
            let corners = self.corners(triangle);
            for vector in [normal(&corners), corners[0], corners[1], corners[2]] {
                bytes.extend(vector.iter().flat_map(|v| (*v as f32).to_le_bytes()));
            }
            bytes.extend([0; 2]);
        }
        bytes
    }

    /// Writes the mesh as text STL, one `solid` for each patch, with all digits.
    pub fn to_stl_text(&self) -> String {
        let mut text = String::new();
        for (index, name) in self.patches().iter().enumerate() {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "solid {name}");
            for triangle in (0..self.triangles().len()).filter(|&triangle| self.patch_index(triangle) == index) {
                let corners = self.corners(triangle);
                let [x, y, z] = normal(&corners);
                let _ = writeln!(text, "  facet normal {x:e} {y:e} {z:e}\n    outer loop");
                for [x, y, z] in corners {
                    let _ = writeln!(text, "      vertex {x:e} {y:e} {z:e}");
                }
                text.push_str("    endloop\n  endfacet\n");
            }
            let _ = writeln!(text, "endsolid {name}");
        }
        text
    }
}

fn normal(corners: &[V3; 3]) -> V3 {
    unit(cross(sub(corners[1], corners[0]), sub(corners[2], corners[0])))
}

fn binary_corners(records: &[u8]) -> Vec<[V3; 3]> {
    let number = |bytes: &[u8]| f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
    let corner =
        |record: &[u8], k: usize| -> V3 { std::array::from_fn(|axis| number(&record[12 + 12 * k + 4 * axis..][..4])) };
    records.chunks_exact(RECORD).map(|record| std::array::from_fn(|k| corner(record, k))).collect()
}

fn from_text(text: &str) -> Result<TriangleMesh, MeshError> {
    let (mut corners, mut names) = (Vec::new(), Vec::new());
    let (mut solid, mut loop_of): (String, Vec<V3>) = ("surface".into(), Vec::new());
    for (number, line) in text.lines().enumerate() {
        let wrong = |what| MeshError::Stl { what, place: format!("line {}", number + 1) };
        let mut words = line.split_whitespace();
        match words.next().map(str::to_ascii_lowercase).as_deref() {
            Some("solid") => {
                let name = words.collect::<Vec<_>>().join(" ");
                solid = if name.is_empty() { "surface".into() } else { name };
            }
            Some("vertex") => {
                let read: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
                loop_of.push(read.try_into().map_err(|_| wrong("a vertex without three numbers"))?);
            }
            Some("endfacet") => {
                let found = std::mem::take(&mut loop_of);
                corners.push(found.try_into().map_err(|_| wrong("a facet without three vertices"))?);
                names.push(solid.clone());
            }
            None | Some("facet" | "outer" | "endloop" | "endsolid") => {}
            Some(_) => return Err(wrong("a word that is not one of STL")),
        }
    }
    if !loop_of.is_empty() {
        return Err(MeshError::Stl { what: "the end of the file within a facet", place: "its end".into() });
    }
    Ok(TriangleMesh::from_soup(&corners)?.with_patches(|triangle| names[triangle].clone()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::triangle_mesh::sleeper_block;

    fn sleeper() -> TriangleMesh {
        sleeper_block([-1.25, -0.125, 0.0], [1.25, 0.125, 0.25]).unwrap()
    }

    /// Text keeps everything but the order of points; binary the shape (all coordinates here are short in base two).
    #[test]
    fn both_kinds_read_back() {
        let mesh = sleeper();
        let text = TriangleMesh::from_stl(mesh.to_stl_text().as_bytes()).unwrap();
        assert_eq!((text.patches(), text.area()), (mesh.patches(), mesh.area()));
        text.check_closed().unwrap();
        let binary = TriangleMesh::from_stl(&mesh.to_stl_binary()).unwrap();
        assert_eq!((binary.points(), binary.triangles()), (mesh.points(), mesh.triangles()));
        assert_eq!(mesh.to_stl_binary().len(), 84 + 12 * 50);
    }

    /// A text file as other programs write it, by hand; and a binary one that begins with `solid`.
    #[test]
    fn files_of_other_programs_are_read() {
        let text = "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1.0E+00 0 0\nVERTEX 0 2 0\nendloop\nendfacet\nendsolid\n";
        let mesh = TriangleMesh::from_stl(text.as_bytes()).unwrap();
        assert_eq!((mesh.area(), mesh.patch(0)), (1.0, "surface"));
        let mut binary = sleeper().to_stl_binary();
        binary[..6].copy_from_slice(b"solid ");
        assert_eq!(TriangleMesh::from_stl(&binary).unwrap().triangles().len(), 12);
    }

    #[test]
    fn broken_files_are_refused_with_the_place() {
        let says = |bytes: &[u8]| TriangleMesh::from_stl(bytes).unwrap_err().to_string();
        let text = sleeper().to_stl_text();
        assert!(
            says(text.replacen("vertex ", "vertex x", 1).as_bytes())
                .starts_with("not an STL mesh: a vertex without three numbers at line 4\n")
        );
        assert!(
            says(text.replacen("endloop", "end", 1).as_bytes()).contains("a word that is not one of STL at line 7")
        );
        let binary = sleeper().to_stl_binary();
        assert!(says(&binary[..binary.len() - 3]).contains("the end of the file at byte 681"));
        assert!(says(b"PK").contains("the end of the file at byte 2"));
        assert_eq!(says(b"solid empty\nendsolid\n"), "the mesh has no triangles");
        // Millimetres taken for metres.
        let large = text.replace("1.25e0", "1.25e3").replace("2.5e-1", "2.5e2");
        assert!(
            says(large.as_bytes()).ends_with(
                "hint: are its coordinates in millimetres? This program reads metres: scale the mesh by 0.001"
            )
        );
    }
}
