//! Uniform solids with a closed-form inertia, in the axes in which it is diagonal.

/// How much of a solid or a mesh there is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// Total mass in kg.
    Mass(f64),
    /// Mass per volume in kg/m³.
    Density(f64),
}

/// A uniform solid; lengths in metres. All are centred on the origin except the cone, whose base
/// stands on the e1e2 plane; axes of revolution lie along e3.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub enum Solid {
    Box {
        lengths: [f64; 3],
    },
    Ellipsoid {
        semi_axes: [f64; 3],
    },
    Sphere {
        radius: f64,
    },
    /// A shell between two radii; equal radii make a thin shell, which needs a mass.
    HollowSphere {
        outer_radius: f64,
        inner_radius: f64,
    },
    Cylinder {
        radius: f64,
        height: f64,
    },
    Cone {
        radius: f64,
        height: f64,
    },
    /// A thin rod along e3: no volume, no moment about e3.
    Rod {
        length: f64,
    },
    /// A thin disc in the e1e2 plane: no volume.
    Disc {
        radius: f64,
    },
    Torus {
        major_radius: f64,
        minor_radius: f64,
    },
    /// A cylinder of the given height with a hemisphere on each end.
    Capsule {
        radius: f64,
        height: f64,
    },
}
