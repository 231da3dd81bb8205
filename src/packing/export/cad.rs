//! Drawings: an AutoCAD script, as in the paper, and DXF.

use std::fmt::Write as _;

use dxf::entities::{Circle, Entity, EntityType, LwPolyline};
use dxf::enums::{AcadVersion, Units};
use dxf::tables::Layer;
use dxf::{Color, Drawing, LwPolylineVertex, Point};

use crate::packing::bed::Packing;
use crate::packing::error::PackingError;

const DOMAIN: &str = "domain";
const STONES: &str = "stones";
/// AutoCAD colour index of the domain: the foreground.
const FOREGROUND: u8 = 7;
/// AutoCAD colour index of the stones: orange.
const ORANGE: u8 = 30;

/// Writes the script file (`.scr`) that draws a packing in AutoCAD: two layers, the domain and a circle per stone, metres.
///
/// Object snap is switched off first, for it would pull the centres to circles drawn before.
pub fn autocad_script(packing: &Packing) -> String {
    let mut text = String::from("_.OSMODE 0\n");
    let layer = |name: &str, colour: u8| format!("_.-LAYER _Make {name} _Color {colour} {name}\n\n");
    let (domain, stones) = (layer(DOMAIN, FOREGROUND), layer(STONES, ORANGE));
    // Writing to a String cannot fail.
    let _ = write!(text, "{domain}_.RECTANG 0,0 {},{}\n{stones}", packing.width.si(), packing.height.si());
    for disc in &packing.discs {
        let _ = writeln!(text, "_.CIRCLE {},{} {}", disc.x, disc.y, disc.radius);
    }
    text.push_str("_.ZOOM _Extents\n");
    text
}

/// Draws a packing as DXF (AutoCAD 2000): the same two layers, metres.
///
/// Dates and identifiers in the header are fixed, so the same packing gives the same bytes.
///
/// # Errors
/// What the DXF writer said.
pub fn dxf(packing: &Packing) -> Result<Vec<u8>, PackingError> {
    let mut drawing = Drawing::new();
    drawing.header.version = AcadVersion::R2000;
    drawing.header.default_drawing_units = Units::Meters;
    // The start of 1970 by the clock of any time zone: the file holds clock time, so a fixed instant would not do.
    drawing.header.creation_date = Default::default();
    drawing.header.creation_date +=
        drawing.header.creation_date.naive_utc() - drawing.header.creation_date.naive_local();
    drawing.header.creation_date_universal = Default::default();
    drawing.header.update_date = drawing.header.creation_date;
    drawing.header.update_date_universal = Default::default();
    drawing.header.fingerprint_guid = Default::default();
    drawing.header.version_guid = Default::default();
    for (name, colour) in [(DOMAIN, FOREGROUND), (STONES, ORANGE)] {
        drawing.add_layer(Layer { name: name.into(), color: Color::from_index(colour), ..Default::default() });
    }
    let (width, height) = (packing.width.si(), packing.height.si());
    let corners = [(0.0, 0.0), (width, 0.0), (width, height), (0.0, height)];
    let mut outline = LwPolyline {
        vertices: corners.map(|(x, y)| LwPolylineVertex { x, y, ..Default::default() }).to_vec(),
        ..Default::default()
    };
    outline.set_is_closed(true);
    add(&mut drawing, DOMAIN, EntityType::LwPolyline(outline));
    for disc in &packing.discs {
        add(&mut drawing, STONES, EntityType::Circle(Circle::new(Point::new(disc.x, disc.y, 0.0), disc.radius)));
    }
    let mut bytes = Vec::new();
    drawing.save(&mut bytes).map_err(|error| PackingError::Drawing { reason: error.to_string() })?;
    Ok(bytes)
}

fn add(drawing: &mut Drawing, layer: &str, shape: EntityType) {
    let mut entity = Entity::new(shape);
    entity.common.layer = layer.into();
    drawing.add_entity(entity);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Disc;
    use crate::units::Metres;

    fn packing() -> Packing {
        let discs = vec![Disc { x: 0.1, y: 0.1, radius: 0.05 }, Disc { x: 0.3, y: 0.125, radius: 0.03125 }];
        Packing::new("file", None, (Metres(0.5), Metres(0.25)), discs)
    }

    #[test]
    fn the_script_draws_the_domain_and_every_stone() {
        assert_eq!(
            autocad_script(&packing()),
            "_.OSMODE 0\n_.-LAYER _Make domain _Color 7 domain\n\n_.RECTANG 0,0 0.5,0.25\n_.-LAYER _Make stones _Color 30 stones\n\n_.CIRCLE 0.1,0.1 0.05\n_.CIRCLE 0.3,0.125 0.03125\n_.ZOOM _Extents\n"
        );
    }

    #[test]
    fn a_dxf_reader_finds_the_stones_and_the_domain() {
        let bytes = dxf(&packing()).unwrap();
        assert_eq!(bytes, dxf(&packing()).unwrap());
        let read = Drawing::load(&mut bytes.as_slice()).unwrap();
        assert_eq!(read.header.default_drawing_units, Units::Meters);
        let mut circles = Vec::new();
        let mut corners = 0;
        for entity in read.entities() {
            match &entity.specific {
                EntityType::Circle(circle) => {
                    assert_eq!(entity.common.layer, STONES);
                    circles.push((circle.center.x, circle.center.y, circle.radius));
                }
                EntityType::LwPolyline(outline) => {
                    assert_eq!((entity.common.layer.as_str(), outline.is_closed()), (DOMAIN, true));
                    corners = outline.vertices.len();
                }
                other => panic!("{other:?}"),
            }
        }
        assert_eq!((circles.as_slice(), corners), (&[(0.1, 0.1, 0.05), (0.3, 0.125, 0.03125)][..], 4));
    }
}
