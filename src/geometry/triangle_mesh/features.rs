//! What a ball may touch of a mesh: its faces, edges and corners, with the lines that part them.

use super::contact::FeatureId;
use super::vector::{V3, cross, dot, length, scaled, sub, unit};

/// Cosine of the angle up to which neighbours are one plane: 1 mrad, what single precision leaves of a plane cut small.
const SAME_PLANE: f64 = 1.0 - 0.5e-6;

/// A triangle as the search for touches sees it.
#[derive(Debug, Clone)]
pub(super) struct Facet {
    /// Outward normal.
    pub normal: V3,
    /// `normal · x` on the plane, m.
    pub offset: f64,
    /// In the plane, across each side, towards the inside; side `k` leads from corner `k` to the next.
    pub inward: [V3; 3],
    /// `inward · x` on each side, m.
    pub inward_offset: [f64; 3],
    /// The edge of each side.
    pub edges: [u32; 3],
    /// The lowest triangle of the plane that this one is a part of.
    pub plane: u32,
}

/// An edge: from its point of lower index to the other.
#[derive(Debug, Clone)]
pub(super) struct Edge {
    pub ends: [u32; 2],
    pub from: V3,
    pub along: V3,
    pub length: f64,
    /// Its triangles: where they begin in the list, and where they end.
    pub triangles: [u32; 2],
    pub feature: FeatureId,
}

/// A point where triangles meet.
#[derive(Debug, Clone)]
pub(super) struct Corner {
    pub at: V3,
    /// Its edges and its triangles: where they begin in the lists, and where they end.
    pub edges: [u32; 2],
    pub triangles: [u32; 2],
    pub feature: FeatureId,
}

/// All of a mesh that a ball may touch, and how it hangs together.
#[derive(Debug, Clone)]
pub(super) struct Features {
    pub facets: Vec<Facet>,
    pub edges: Vec<Edge>,
    pub corners: Vec<Corner>,
    /// Triangle and its side, edge by edge.
    pub edge_triangles: Vec<(u32, u8)>,
    /// Edge and whether it leads away, corner by corner.
    pub corner_edges: Vec<(u32, bool)>,
    /// Triangle and which of its corners, corner by corner.
    pub corner_triangles: Vec<(u32, u8)>,
    /// Lengths below this are rounding, m.
    pub tiny: f64,
}

impl Features {
    /// Reads the features off a mesh whose indices and areas have been checked.
    pub fn of(points: &[V3], triangles: &[[u32; 3]]) -> Self {
        let mut facets: Vec<Facet> = triangles.iter().map(|corners| facet(points, *corners)).collect();
        let (edges, edge_triangles) = edges(points, triangles, &mut facets);
        let (corners, corner_edges, corner_triangles) = corners(points, triangles, &edges);
        let far = points.iter().flatten().fold(0.0, |far: f64, v| far.max(v.abs()));
        let mut features =
            Self { facets, edges, corners, edge_triangles, corner_edges, corner_triangles, tiny: 1e-13 + 4e-14 * far };
        features.find_planes();
        features.name_edges();
        features.name_corners();
        features
    }

    /// Every edge with its triangles and their sides, in the order of their points.
    pub fn edges_with_triangles(&self) -> impl Iterator<Item = ([u32; 2], &[(u32, u8)])> + Clone {
        self.edges.iter().map(|edge| (edge.ends, self.at_edge(edge)))
    }

    /// Triangles at an edge, and which of their sides it is.
    pub fn at_edge(&self, edge: &Edge) -> &[(u32, u8)] {
        &self.edge_triangles[edge.triangles[0] as usize..edge.triangles[1] as usize]
    }

    /// Edges at a corner, and whether they lead away from it.
    pub fn edges_at(&self, corner: &Corner) -> &[(u32, bool)] {
        &self.corner_edges[corner.edges[0] as usize..corner.edges[1] as usize]
    }

    /// Triangles at a corner, and which of their corners it is.
    pub fn triangles_at(&self, corner: &Corner) -> &[(u32, u8)] {
        &self.corner_triangles[corner.triangles[0] as usize..corner.triangles[1] as usize]
    }

    /// Spreads each plane from its lowest triangle over neighbours that lie in it.
    fn find_planes(&mut self) {
        let mut found = vec![false; self.facets.len()];
        for first in 0..self.facets.len() {
            if found[first] {
                continue;
            }
            let normal = self.facets[first].normal;
            let mut open = vec![first];
            found[first] = true;
            while let Some(triangle) = open.pop() {
                self.facets[triangle].plane = first as u32;
                for edge in self.facets[triangle].edges {
                    let [from, to] = self.edges[edge as usize].triangles;
                    for &(other, _) in &self.edge_triangles[from as usize..to as usize] {
                        let other = other as usize;
                        if !found[other] && self.same_plane(normal, triangle, other) {
                            found[other] = true;
                            open.push(other);
                        }
                    }
                }
            }
        }
    }

    /// Whether a neighbour goes on in the plane: the same normal, or the opposite one if it is wound the other way, and not
    /// folded back over the triangle.
    fn same_plane(&self, normal: V3, triangle: usize, other: usize) -> bool {
        if dot(normal, self.facets[other].normal).abs() < SAME_PLANE {
            return false;
        }
        let shared = |of: usize| {
            let facet = &self.facets[of];
            let with = &self.facets[if of == other { triangle } else { other }];
            (0..3).find(|&side| with.edges.contains(&facet.edges[side])).map(|side| facet.inward[side])
        };
        match (shared(triangle), shared(other)) {
            (Some(a), Some(b)) => dot(a, b) < 0.0,
            _ => false,
        }
    }

    /// An edge within a plane is that plane; edges in one line, between the same planes, bear the name of the lowest.
    fn name_edges(&mut self) {
        for index in 0..self.edges.len() {
            let plane = self.one_plane(self.at_edge(&self.edges[index]));
            let name = plane.unwrap_or(FeatureId::Edge(index as u32));
            self.edges[index].feature = name;
        }
        let planes = |features: &Self, edge: usize| {
            let sides = features.at_edge(&features.edges[edge]);
            let mut planes: Vec<_> =
                sides.iter().map(|&(triangle, _)| features.facets[triangle as usize].plane).collect();
            planes.sort_unstable();
            planes
        };
        for first in 0..self.edges.len() {
            if self.edges[first].feature != FeatureId::Edge(first as u32) {
                continue;
            }
            let (along, of) = (self.edges[first].along, planes(self, first));
            let mut open = vec![first];
            while let Some(edge) = open.pop() {
                for end in self.edges[edge].ends {
                    for at in self.corners[end as usize].edges[0]..self.corners[end as usize].edges[1] {
                        let next = self.corner_edges[at as usize].0 as usize;
                        let unnamed = next > first && self.edges[next].feature == FeatureId::Edge(next as u32);
                        let in_line = dot(along, self.edges[next].along).abs() >= SAME_PLANE;
                        if unnamed && in_line && planes(self, next) == of {
                            self.edges[next].feature = FeatureId::Edge(first as u32);
                            open.push(next);
                        }
                    }
                }
            }
        }
    }

    /// A corner within a plane is that plane, one within a straight edge that edge.
    fn name_corners(&mut self) {
        for index in 0..self.corners.len() {
            let corner = &self.corners[index];
            let around = self.edges_at(corner);
            let inside =
                around.iter().all(|&(edge, _)| matches!(self.edges[edge as usize].feature, FeatureId::Face(_)));
            let mut lines = around.iter().map(|&(edge, _)| self.edges[edge as usize].feature);
            let ridge = lines.clone().find(|feature| matches!(feature, FeatureId::Edge(_)));
            let name = if inside {
                self.one_plane(self.triangles_at(corner))
            } else {
                // Two pieces of one straight edge, and nothing else but what lies within planes.
                let pieces = lines.clone().filter(|feature| Some(*feature) == ridge).count();
                let others = lines.any(|feature| Some(feature) != ridge && matches!(feature, FeatureId::Edge(_)));
                ridge.filter(|_| pieces == 2 && !others)
            };
            self.corners[index].feature = name.unwrap_or(FeatureId::Corner(index as u32));
        }
    }

    /// The plane that several triangles share, if there are two or more and they do.
    fn one_plane(&self, triangles: &[(u32, u8)]) -> Option<FeatureId> {
        let plane = |&(triangle, _): &(u32, u8)| self.facets[triangle as usize].plane;
        let first = plane(triangles.first()?);
        (triangles.len() > 1 && triangles.iter().all(|triangle| plane(triangle) == first))
            .then_some(FeatureId::Face(first))
    }
}

fn facet(points: &[V3], corners: [u32; 3]) -> Facet {
    let at = corners.map(|index| points[index as usize]);
    let normal = unit(cross(sub(at[1], at[0]), sub(at[2], at[0])));
    let inward = std::array::from_fn(|side| unit(cross(normal, sub(at[(side + 1) % 3], at[side]))));
    Facet {
        normal,
        offset: dot(normal, at[0]),
        inward,
        inward_offset: std::array::from_fn(|side| dot(inward[side], at[side])),
        edges: [0; 3],
        plane: 0,
    }
}

fn edges(points: &[V3], triangles: &[[u32; 3]], facets: &mut [Facet]) -> (Vec<Edge>, Vec<(u32, u8)>) {
    let mut sides: Vec<([u32; 2], u32, u8)> = Vec::with_capacity(3 * triangles.len());
    for (triangle, corners) in triangles.iter().enumerate() {
        for side in 0..3 {
            let (a, b) = (corners[side], corners[(side + 1) % 3]);
            sides.push(([a.min(b), a.max(b)], triangle as u32, side as u8));
        }
    }
    sides.sort_unstable();
    let mut edges: Vec<Edge> = Vec::new();
    for (at, &(ends, triangle, side)) in sides.iter().enumerate() {
        if edges.last().is_none_or(|edge| edge.ends != ends) {
            let [from, to] = ends.map(|index| points[index as usize]);
            let (across, index) = (sub(to, from), edges.len() as u32);
            let long = length(across);
            let (along, triangles) = (scaled(across, 1.0 / long), [at as u32; 2]);
            edges.push(Edge { ends, from, along, length: long, triangles, feature: FeatureId::Edge(index) });
        }
        facets[triangle as usize].edges[usize::from(side)] = edges.len() as u32 - 1;
        if let Some(edge) = edges.last_mut() {
            edge.triangles[1] = at as u32 + 1;
        }
    }
    (edges, sides.into_iter().map(|(_, triangle, side)| (triangle, side)).collect())
}

type Corners = (Vec<Corner>, Vec<(u32, bool)>, Vec<(u32, u8)>);

fn corners(points: &[V3], triangles: &[[u32; 3]], edges: &[Edge]) -> Corners {
    let mut by_edge: Vec<(u32, u32, bool)> = Vec::with_capacity(2 * edges.len());
    for (index, edge) in edges.iter().enumerate() {
        by_edge.push((edge.ends[0], index as u32, true));
        by_edge.push((edge.ends[1], index as u32, false));
    }
    by_edge.sort_unstable();
    let mut by_triangle: Vec<(u32, u32, u8)> = Vec::with_capacity(3 * triangles.len());
    for (triangle, corners) in triangles.iter().enumerate() {
        by_triangle.extend((0..3).map(|k| (corners[k], triangle as u32, k as u8)));
    }
    by_triangle.sort_unstable();
    let (mut edge_at, mut triangle_at) = (0, 0);
    let corners = points.iter().enumerate().map(|(index, &at)| {
        let (first_edge, first_triangle) = (edge_at, triangle_at);
        while by_edge.get(edge_at).is_some_and(|entry| entry.0 as usize == index) {
            edge_at += 1;
        }
        while by_triangle.get(triangle_at).is_some_and(|entry| entry.0 as usize == index) {
            triangle_at += 1;
        }
        Corner {
            at,
            edges: [first_edge as u32, edge_at as u32],
            triangles: [first_triangle as u32, triangle_at as u32],
            feature: FeatureId::Corner(index as u32),
        }
    });
    let corners = corners.collect();
    let by_edge = by_edge.into_iter().map(|(_, edge, away)| (edge, away)).collect();
    (corners, by_edge, by_triangle.into_iter().map(|(_, triangle, corner)| (triangle, corner)).collect())
}
