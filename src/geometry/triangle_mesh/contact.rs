//! Where a ball touches a mesh: one touch for each nearest place, whatever triangles the surface is cut into.
//!
//! A place of the surface is touched when it is a *local minimum* of the distance to the centre of the ball: the foot on a
//! face it lies inside of; the foot on an edge when no triangle at that edge leads nearer; a corner when neither an edge nor
//! a triangle at it does. This is the order face, edge, vertex of Santasusana et al. 2016 (Comp. Part. Mech. 3, 407-428:
//! a face hides its edges and an edge its vertices), decided from what is at each feature instead of from the list of
//! candidates, so that it depends neither on their order nor on their number. Two planes of a concave edge touch once
//! each; a floor cut into triangles touches once.
//!
//! Touches whose normals differ by less than [`MERGED`] are one, the deepest: across a concave edge as flat as that
//! both planes would be felt until one of them ends all at once.

use super::mesh::TriangleMesh;
use super::vector::{V3, dot, scaled, sub};

/// Cosine of the angle between the normals of two touches below which they count as one: 1 degree. A ball whose overlap is
/// below `1 - cos` of this angle, 1.5e-4 of its radius, loses a second touch only where its depth is zero.
pub const MERGED: f64 = 0.999_847_695_156_391_3;
/// The most touches of one ball with one mesh that are kept; the shallowest give way.
pub const MOST_TOUCHES: usize = 12;

/// What of a mesh is touched. Stable as long as the mesh is, ordered, and the same over all triangles of one plane and over
/// all pieces of one straight edge, so that the history of a contact goes on when a ball rolls across them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, serde::Serialize, serde::Deserialize)]
pub enum FeatureId {
    /// A plane, by its lowest triangle.
    Face(u32),
    /// A straight edge, by its lowest piece.
    Edge(u32),
    /// A corner, by its point.
    Corner(u32),
}

impl FeatureId {
    fn rank(self) -> u8 {
        match self {
            Self::Face(_) => 0,
            Self::Edge(_) => 1,
            Self::Corner(_) => 2,
        }
    }
}

/// One touch of a ball with a mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// What is touched.
    pub feature: FeatureId,
    /// From the surface to the centre of the ball, of length one.
    pub normal: V3,
    /// How deep the ball lies in the surface, m; above zero.
    pub depth: f64,
    /// The touched place of the surface, m.
    pub point: V3,
    /// A triangle at that place.
    pub triangle: u32,
}

const NONE: Touch = Touch { feature: FeatureId::Face(0), normal: [0.0; 3], depth: 0.0, point: [0.0; 3], triangle: 0 };

/// Touches of one ball, in the order of their features. Lives on the stack; use one again for the next ball.
#[derive(Debug, Clone)]
pub struct Touches {
    count: usize,
    kept: [Touch; MOST_TOUCHES],
}

impl Default for Touches {
    fn default() -> Self {
        Self { count: 0, kept: [NONE; MOST_TOUCHES] }
    }
}

impl Touches {
    /// No touches.
    pub fn new() -> Self {
        Self::default()
    }

    /// The touches.
    pub fn as_slice(&self) -> &[Touch] {
        &self.kept[..self.count]
    }

    /// Takes a touch, unless a deeper one of the same direction is there.
    fn take(&mut self, touch: Touch, tiny: f64) {
        for kept in &mut self.kept[..self.count] {
            if dot(kept.normal, touch.normal) > MERGED {
                let deeper = touch.depth - kept.depth;
                let first = (touch.feature.rank(), touch.feature, touch.triangle)
                    < (kept.feature.rank(), kept.feature, kept.triangle);
                if deeper > tiny || (deeper >= -tiny && first) {
                    *kept = touch;
                }
                return;
            }
        }
        if self.count < MOST_TOUCHES {
            self.kept[self.count] = touch;
            self.count += 1;
        } else if let Some(least) = self.kept.iter_mut().min_by(|a, b| a.depth.total_cmp(&b.depth))
            && least.depth < touch.depth
        {
            *least = touch;
        }
    }
}

impl TriangleMesh {
    /// Finds where a ball touches the mesh; `candidates` are the triangles that may be near (any order, more than needed
    /// does no harm, but every triangle within `radius` of `centre` must be among them).
    ///
    /// Lengths in metres, in the frame of the mesh. Both sides of a triangle count: the normal points to the side on
    /// which the centre lies. Nothing is allocated.
    ///
    /// # Panics
    /// When a candidate is not a triangle of this mesh.
    pub fn touches(&self, centre: V3, radius: f64, candidates: &[u32], touches: &mut Touches) {
        touches.count = 0;
        let search = Search { mesh: self, centre, radius };
        for &triangle in candidates {
            search.look_at(triangle, touches);
        }
        touches.kept[..touches.count].sort_unstable_by_key(|touch| touch.feature);
    }

    /// Distance from a place to the nearest point of a triangle, m.
    ///
    /// # Panics
    /// When there is no such triangle.
    pub fn distance_to(&self, triangle: u32, place: V3) -> f64 {
        let facet = &self.features.facets[triangle as usize];
        let height = dot(facet.normal, place) - facet.offset;
        let mut nearest = f64::INFINITY;
        let mut inside = true;
        for side in 0..3 {
            if dot(facet.inward[side], place) < facet.inward_offset[side] {
                inside = false;
                let edge = &self.features.edges[facet.edges[side] as usize];
                let from = sub(place, edge.from);
                let off = sub(from, scaled(edge.along, dot(from, edge.along).clamp(0.0, edge.length)));
                nearest = nearest.min(dot(off, off));
            }
        }
        if inside { height.abs() } else { nearest.sqrt() }
    }
}

/// One ball in front of one mesh.
struct Search<'a> {
    mesh: &'a TriangleMesh,
    centre: V3,
    radius: f64,
}

impl Search<'_> {
    #[inline]
    fn look_at(&self, triangle: u32, touches: &mut Touches) {
        let features = &self.mesh.features;
        let (facet, tiny) = (&features.facets[triangle as usize], features.tiny);
        let height = dot(facet.normal, self.centre) - facet.offset;
        if height.abs() >= self.radius {
            return;
        }
        let within: [f64; 3] = std::array::from_fn(|side| self.within(triangle, side));
        if within.iter().all(|&within| within >= -tiny) {
            let normal = if height < 0.0 { scaled(facet.normal, -1.0) } else { facet.normal };
            let point = sub(self.centre, scaled(facet.normal, height));
            let feature = FeatureId::Face(facet.plane);
            touches.take(Touch { feature, normal, depth: self.radius - height.abs(), point, triangle }, tiny);
            return;
        }
        let room = self.radius * self.radius - height * height;
        for (within, edge) in within.into_iter().zip(facet.edges) {
            if within <= tiny && within * within < room {
                self.look_at_edge(triangle, edge, touches);
            }
        }
    }

    /// How far the centre lies inside a side of a triangle, seen along its normal.
    #[inline]
    fn within(&self, triangle: u32, side: usize) -> f64 {
        let facet = &self.mesh.features.facets[triangle as usize];
        dot(facet.inward[side], self.centre) - facet.inward_offset[side]
    }

    fn look_at_edge(&self, triangle: u32, index: u32, touches: &mut Touches) {
        let features = &self.mesh.features;
        let (edge, tiny) = (&features.edges[index as usize], features.tiny);
        let along = dot(sub(self.centre, edge.from), edge.along);
        if along <= tiny {
            self.look_at_corner(triangle, edge.ends[0], touches);
        }
        if along >= edge.length - tiny {
            self.look_at_corner(triangle, edge.ends[1], touches);
        }
        if along < -tiny || along > edge.length + tiny {
            return;
        }
        let nearer = |&(triangle, side): &(u32, u8)| self.within(triangle, usize::from(side)) > tiny;
        if !features.at_edge(edge).iter().any(nearer) {
            let foot: V3 = std::array::from_fn(|k| edge.from[k] + along * edge.along[k]);
            self.touch_at(foot, edge.feature, triangle, touches);
        }
    }

    fn look_at_corner(&self, triangle: u32, index: u32, touches: &mut Touches) {
        let features = &self.mesh.features;
        let (corner, tiny) = (&features.corners[index as usize], features.tiny);
        let from = sub(self.centre, corner.at);
        let along_leads_nearer = |&(edge, away): &(u32, bool)| {
            let along = dot(from, features.edges[edge as usize].along);
            (if away { along } else { -along }) > tiny
        };
        let into_leads_nearer = |&(triangle, at): &(u32, u8)| {
            let (after, before) = (usize::from(at), (usize::from(at) + 2) % 3);
            self.within(triangle, after) > tiny && self.within(triangle, before) > tiny
        };
        if !features.edges_at(corner).iter().any(along_leads_nearer)
            && !features.triangles_at(corner).iter().any(into_leads_nearer)
        {
            self.touch_at(corner.at, corner.feature, triangle, touches);
        }
    }

    fn touch_at(&self, point: V3, feature: FeatureId, triangle: u32, touches: &mut Touches) {
        let off = sub(self.centre, point);
        let distance = dot(off, off).sqrt();
        if distance >= self.radius {
            return;
        }
        let features = &self.mesh.features;
        let normal =
            if distance > 0.0 { scaled(off, 1.0 / distance) } else { features.facets[triangle as usize].normal };
        touches.take(Touch { feature, normal, depth: self.radius - distance, point, triangle }, features.tiny);
    }
}

#[cfg(test)]
#[path = "contact_tests.rs"]
mod tests;
