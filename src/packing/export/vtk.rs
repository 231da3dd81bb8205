//! Beds of spheres for ParaView: VTK's XML polydata.

use std::fmt::Write as _;

use crate::packing::spheres::{SphereBed, TOUCHING};

/// Writes the stones as points with `radius`, `diameter` and `contacts`: in ParaView `Glyph`, shape sphere, scaled by
/// `diameter`.
///
/// The counts in the head are those of the lists below it: each stone is a point and a vertex.
pub fn stones_vtp(bed: &SphereBed) -> String {
    let count = bed.spheres.len();
    let numbers = bed.contact_numbers(TOUCHING);
    let mut text = head(count, count, 0);
    text.push_str("<PointData Scalars=\"diameter\">\n");
    array(&mut text, "Float64", "radius", 1, bed.spheres.iter().map(|sphere| sphere.radius.to_string()));
    array(&mut text, "Float64", "diameter", 1, bed.spheres.iter().map(|sphere| (2.0 * sphere.radius).to_string()));
    array(&mut text, "UInt32", "contacts", 1, numbers.iter().map(u32::to_string));
    text.push_str("</PointData>\n<Points>\n");
    array(&mut text, "Float64", "centre", 3, bed.spheres.iter().map(|sphere| place(sphere.centre)));
    text.push_str("</Points>\n<Verts>\n");
    array(&mut text, "Int64", "connectivity", 1, (0..count).map(|k| k.to_string()));
    array(&mut text, "Int64", "offsets", 1, (1..=count).map(|k| k.to_string()));
    text.push_str("</Verts>\n");
    close(text)
}

/// Writes the contacts as lines between the centres of the stones, with `normal_force` in newtons: force chains. Contacts
/// across the rim of a bed that repeats itself are left out, as their line would cross it.
pub fn contacts_vtp(bed: &SphereBed) -> String {
    let apart = |k: usize, axis: usize| {
        let contact = &bed.contacts[k];
        let [a, b] = [contact.first, contact.second].map(|end| bed.spheres[end as usize].centre[axis]);
        bed.periodic[axis] && (a - b).abs() > 0.5 * bed.size[axis].si()
    };
    let kept: Vec<_> =
        (0..bed.contacts.len()).filter(|k| !apart(*k, 0) && !apart(*k, 1)).map(|k| bed.contacts[k]).collect();
    let mut text = head(bed.spheres.len(), 0, kept.len());
    text.push_str("<Points>\n");
    array(&mut text, "Float64", "centre", 3, bed.spheres.iter().map(|sphere| place(sphere.centre)));
    text.push_str("</Points>\n<Lines>\n");
    array(&mut text, "Int64", "connectivity", 1, kept.iter().map(|c| format!("{} {}", c.first, c.second)));
    array(&mut text, "Int64", "offsets", 1, (1..=kept.len()).map(|k| (2 * k).to_string()));
    text.push_str("</Lines>\n<CellData Scalars=\"normal_force\">\n");
    array(&mut text, "Float64", "normal_force", 1, kept.iter().map(|c| c.normal_force.to_string()));
    text.push_str("</CellData>\n");
    close(text)
}

fn place([x, y, z]: [f64; 3]) -> String {
    format!("{x} {y} {z}")
}

fn head(points: usize, vertices: usize, lines: usize) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" \
         header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\"{points}\" NumberOfVerts=\"{vertices}\" \
         NumberOfLines=\"{lines}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n"
    )
}

fn close(mut text: String) -> String {
    text.push_str("</Piece>\n</PolyData>\n</VTKFile>\n");
    text
}

fn array(text: &mut String, kind: &str, name: &str, components: usize, values: impl Iterator<Item = String>) {
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"ascii\">"
    );
    for value in values {
        text.push_str(&value);
        text.push('\n');
    }
    text.push_str("</DataArray>\n");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Sphere;
    use crate::packing::spheres::SphereContact;
    use crate::units::Metres;

    /// Numbers of each array of a file, by name.
    fn arrays(text: &str) -> Vec<(String, Vec<f64>)> {
        text.split("<DataArray ")
            .skip(1)
            .map(|part| {
                let name = part.split("Name=\"").nth(1).unwrap().split('"').next().unwrap();
                let body = part.split_once('>').unwrap().1.split("</DataArray>").next().unwrap();
                (name.to_string(), body.split_whitespace().map(|number| number.parse().unwrap()).collect())
            })
            .collect()
    }

    /// As many numbers in each list as the head promises: a file with points and no polydata shows nothing.
    #[test]
    fn the_counts_are_those_of_the_lists() {
        let spheres: Vec<_> =
            (0..3).map(|k| Sphere { centre: [0.05, 0.05, 0.05 + 0.1 * f64::from(k)], radius: 0.05 }).collect();
        let mut bed = SphereBed::new("file", None, [Metres(0.1), Metres(0.1), Metres(0.4)], spheres);
        bed.contacts = vec![SphereContact { first: 0, second: 1, normal_force: 2.5 }];
        let text = stones_vtp(&bed);
        assert!(text.contains("NumberOfPoints=\"3\" NumberOfVerts=\"3\" NumberOfLines=\"0\""));
        let counts: Vec<_> = arrays(&text).into_iter().map(|(name, numbers)| (name, numbers.len())).collect();
        let wanted =
            [("radius", 3), ("diameter", 3), ("contacts", 3), ("centre", 9), ("connectivity", 3), ("offsets", 3)];
        assert_eq!(counts, wanted.map(|(name, count)| (name.to_string(), count)));
        assert_eq!(arrays(&text)[2].1, [1.0, 1.0, 0.0]);
        let text = contacts_vtp(&bed);
        assert!(text.contains("NumberOfPoints=\"3\" NumberOfVerts=\"0\" NumberOfLines=\"1\""));
        let lists = arrays(&text);
        assert_eq!(lists[1], ("connectivity".to_string(), vec![0.0, 1.0]));
        assert_eq!(lists[2], ("offsets".to_string(), vec![2.0]));
        assert_eq!(lists[3], ("normal_force".to_string(), vec![2.5]));
    }
}
