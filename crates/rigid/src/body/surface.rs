//! Surfaces of bodies as triangle meshes, for drawing.
//!
//! A solid of revolution is a profile, points `(r, z)` from the lower pole to the upper one, swept about e3. A body known
//! only by its inertia is drawn as a uniform box, or as a spinning top if it is symmetric and has a fixed point.

use super::mesh::TriangleMesh;
use super::solids::Solid;
use polhode_ga::{Rotor, Vector};
use std::array::from_fn;
use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// Faces around an axis of revolution; a multiple of four, so that each face lies in one quadrant.
const SIDES: usize = 64;
/// Faces from pole to pole of a sphere, and around the tube of a torus.
const STACKS: usize = 32;
/// The least thickness of a drawn body, relative to its longest side.
const THIN: f64 = 0.03;
/// A box is drawn as a ball if its shortest side exceeds this fraction of its longest.
const BALL: f64 = 0.95;
/// The longest distance from the fixed point in a box on an arm, relative to the length of the arm.
const BOX_ON_ARM: f64 = 0.6;
/// Profile of a spinning top with its tip at the origin and its centre of mass at height 1.
const TOP: [[f64; 2]; 12] = [
    [0.0, 0.0],
    [0.025, 0.03],
    [0.1, 0.24],
    [0.3, 0.54],
    [0.54, 0.78],
    [0.66, 0.96],
    [0.64, 1.1],
    [0.46, 1.22],
    [0.16, 1.3],
    [0.055, 1.38],
    [0.05, 1.6],
    [0.0, 1.63],
];

/// A closed surface: vertices in m, and triangles counterclockwise seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Surface {
    /// Positions in m.
    pub vertices: Vec<Vector>,
    /// Triangles as indices of vertices.
    pub faces: Vec<[u32; 3]>,
    /// Colour number of each triangle: 0, 1 for alternating quadrants of a solid of revolution; 2, 3, 4 for the sides
    /// of a box across e1, e2, e3; 0 for a mesh.
    pub tints: Vec<u32>,
}

impl Surface {
    /// The surface of a mesh.
    pub fn of_mesh(mesh: &TriangleMesh) -> Surface {
        let faces = mesh.faces().to_vec();
        Surface { vertices: mesh.vertices().to_vec(), tints: vec![0; faces.len()], faces }
    }

    /// The outer surface of a solid in its own axes; a rod and a disc get the least thickness.
    pub fn of_solid(solid: Solid) -> Surface {
        match solid {
            Solid::Box { lengths } => cuboid(lengths),
            Solid::Ellipsoid { semi_axes } => ellipsoid(semi_axes),
            Solid::Sphere { radius } | Solid::HollowSphere { outer_radius: radius, .. } => {
                ellipsoid([radius; 3])
            }
            Solid::Cylinder { radius, height } => cylinder(radius, height),
            Solid::Cone { radius, height } => revolved(&[[0.0, 0.0], [radius, 0.0], [0.0, height]]),
            Solid::Rod { length } => cylinder(0.5 * THIN * length, length),
            Solid::Disc { radius } => cylinder(radius, 2.0 * THIN * radius),
            Solid::Torus { major_radius, minor_radius } => {
                let point = |k| {
                    let (sin, cos) = (2.0 * PI * k as f64 / STACKS as f64).sin_cos();
                    [major_radius + minor_radius * cos, minor_radius * sin]
                };
                revolved(&(0..STACKS).map(point).collect::<Vec<_>>())
            }
            Solid::Capsule { radius, height } => {
                let cap = |points: RangeInclusive<usize>, base: f64| {
                    points.map(arc_point).map(move |[r, z]| [radius * r, base + radius * z])
                };
                let half = STACKS / 2;
                let [lower, upper] = [cap(0..=half, -0.5 * height), cap(half..=STACKS, 0.5 * height)];
                revolved(&lower.chain(upper).collect::<Vec<_>>())
            }
        }
    }

    /// The surface of a body known only by mass and inertia: a uniform box with these principal moments, or a ball if
    /// its sides are nearly equal. `frame` takes principal axes to body axes.
    ///
    /// `arm` leads from the fixed point to the centre of mass, 0 for a free body. With an arm along an axis of symmetry
    /// the surface is a spinning top, with any other the box, scaled to fit.
    pub fn of_inertia(mass: f64, moments: [f64; 3], frame: Rotor, arm: Vector) -> Surface {
        let length = arm.norm();
        if length > 0.0 && symmetric_about(arm, moments, frame) {
            let upright = Rotor::from_vectors(Vector([0.0, 0.0, 1.0]), arm).unwrap_or(Rotor::IDENTITY);
            return revolved(&smooth(&TOP)).transformed(|x| upright.apply(x) * length);
        }
        let surface = Surface::of_solid(equivalent(mass, moments));
        let farthest = surface.vertices.iter().map(|x| x.norm()).fold(0.0, f64::max);
        let scale = if length > 0.0 && farthest > 0.0 { BOX_ON_ARM * length / farthest } else { 1.0 };
        surface.transformed(|x| frame.apply(x) * scale + arm)
    }

    /// The surface with each vertex moved.
    pub fn transformed(mut self, map: impl Fn(Vector) -> Vector) -> Surface {
        self.vertices.iter_mut().for_each(|x| *x = map(*x));
        self
    }

    /// The side lengths of the bounding box.
    pub fn extents(&self) -> [f64; 3] {
        from_fn(|k| {
            let bound = |best: fn(f64, f64) -> f64| self.vertices.iter().map(|x| x.0[k]).reduce(best);
            bound(f64::max).zip(bound(f64::min)).map_or(0.0, |(most, least)| most - least)
        })
    }
}

/// The uniform box, or ball, with this mass and nearly these principal moments: `i1 = m (b² + c²)/12`.
fn equivalent(mass: f64, [i1, i2, i3]: [f64; 3]) -> Solid {
    let squares = [i2 + i3 - i1, i3 + i1 - i2, i1 + i2 - i3].map(|sum| 6.0 * sum.max(0.0) / mass);
    let lengths = squares.map(f64::sqrt);
    let longest = lengths.into_iter().fold(0.0, f64::max);
    let lengths = lengths.map(|length| length.max(THIN * longest));
    if lengths.iter().all(|&length| length > BALL * longest) {
        return Solid::Ellipsoid { semi_axes: lengths.map(|length| 0.5 * length) };
    }
    Solid::Box { lengths }
}

/// Whether a direction in body axes is an axis of symmetry of the inertia.
fn symmetric_about(arm: Vector, moments: [f64; 3], frame: Rotor) -> bool {
    let along = frame.reverse().apply(arm).0.map(|x| x.abs() / arm.norm());
    (0..3).any(|k| {
        let [a, b] = [moments[(k + 1) % 3], moments[(k + 2) % 3]];
        along[k] > 0.999 && (a - b).abs() < 1e-6 * a.max(b)
    })
}

fn cuboid(lengths: [f64; 3]) -> Surface {
    // Vertex 4 i + 2 j + k has the coordinates -1 or 1 that i, j and k choose, times half the lengths.
    let vertex = |v: usize| Vector(from_fn(|k| if v >> (2 - k) & 1 == 1 { 0.5 } else { -0.5 } * lengths[k]));
    let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    Surface {
        vertices: (0..8).map(vertex).collect(),
        faces: quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        tints: (0..12).map(|face| 2 + face / 4).collect(),
    }
}

fn cylinder(radius: f64, height: f64) -> Surface {
    let [low, high] = [-0.5 * height, 0.5 * height];
    revolved(&[[0.0, low], [radius, low], [radius, high], [0.0, high]])
}

fn ellipsoid(semi_axes: [f64; 3]) -> Surface {
    let sphere = revolved(&(0..=STACKS).map(arc_point).collect::<Vec<_>>());
    sphere.transformed(|Vector(x)| Vector(from_fn(|k| semi_axes[k] * x[k])))
}

/// Point k of the profile of the unit sphere; both poles are on the axis exactly.
fn arc_point(k: usize) -> [f64; 2] {
    let angle = |k: usize| PI * k as f64 / STACKS as f64;
    [angle(k.min(STACKS - k)).sin(), -angle(k).cos()]
}

/// The surface that a profile sweeps about e3, from pole to pole; a profile that begins off the axis is closed.
fn revolved(profile: &[[f64; 2]]) -> Surface {
    let mut vertices = Vec::new();
    let mut ring = |&[r, z]: &[f64; 2]| -> Vec<u32> {
        let count = if r > 0.0 { SIDES } else { 1 };
        let first = vertices.len() as u32;
        vertices.extend((0..count).map(|k| {
            let (sin, cos) = (2.0 * PI * k as f64 / SIDES as f64).sin_cos();
            Vector([r * cos, r * sin, z])
        }));
        (0..SIDES).map(|k| first + (k % count) as u32).collect()
    };
    let mut rings: Vec<Vec<u32>> = profile.iter().map(&mut ring).collect();
    if profile[0][0] > 0.0 {
        rings.push(rings[0].clone());
    }
    let (mut faces, mut tints) = (Vec::new(), Vec::new());
    for pair in rings.windows(2) {
        for k in 0..SIDES {
            let [a, b, c, d] = [pair[0][k], pair[0][(k + 1) % SIDES], pair[1][(k + 1) % SIDES], pair[1][k]];
            // At a pole a quadrilateral is a triangle.
            for face in [[a, b, c], [a, c, d]].into_iter().filter(|[a, b, c]| a != b && b != c && c != a) {
                faces.push(face);
                tints.push((k / (SIDES / 4)).is_multiple_of(2).into());
            }
        }
    }
    Surface { vertices, faces, tints }
}

/// The Catmull–Rom spline through points, in four steps from each to the next.
fn smooth(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let at = |k: usize| points[k.clamp(1, points.len()) - 1];
    let step = |n: usize| {
        let (k, t) = (n / 4 + 1, (n % 4) as f64 / 4.0);
        from_fn(|i| {
            let [a, b, c, d] = [at(k - 1), at(k), at(k + 1), at(k + 2)].map(|point| point[i]);
            let curve =
                b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
            if i == 0 { curve.max(0.0) } else { curve }
        })
    };
    (0..=4 * (points.len() - 1)).map(step).collect()
}
