//! Uniform solids with a closed-form inertia, in the axes in which it is diagonal.

use super::Body;
use super::inertia::Inertia;
use crate::error::BodyError;
use crate::facts;
use crate::facts::Facts;
use polhode_ga::Vector;
use std::f64::consts::PI;

/// The mass or the density of a solid or a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Amount {
    /// Total mass in kg.
    Mass(f64),
    /// Mass per volume in kg/m³.
    Density(f64),
}

/// Solids, each with its kind in scenes and its sizes.
macro_rules! solids {
    ($($(#[$doc:meta])* $solid:ident = $kind:literal { $($size:ident: $type:ty),* };)*) => {
        /// A uniform solid; lengths in metres. All are centred on the origin except the cone, whose base is in the e1e2
        /// plane; axes of revolution are along e3.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(missing_docs)]
        pub enum Solid {
            $($(#[$doc])* $solid { $($size: $type),* }),*
        }

        impl Solid {
            /// Its `kind` and its sizes in metres, named as in scenes.
            pub fn facts(self) -> Facts {
                match self {
                    $(Solid::$solid { $($size),* } => facts! { kind: $kind, $($size: $size),* }),*
                }
            }
        }
    };
}

solids! {
    Box = "box" { lengths: [f64; 3] };
    Ellipsoid = "ellipsoid" { semi_axes: [f64; 3] };
    Sphere = "sphere" { radius: f64 };
    /// A shell between two radii; equal radii make a thin shell, which needs a mass.
    HollowSphere = "hollow_sphere" { outer_radius: f64, inner_radius: f64 };
    Cylinder = "cylinder" { radius: f64, height: f64 };
    Cone = "cone" { radius: f64, height: f64 };
    /// A thin rod along e3: no volume, no moment about e3.
    Rod = "rod" { length: f64 };
    /// A thin disc in the e1e2 plane: no volume.
    Disc = "disc" { radius: f64 };
    Torus = "torus" { major_radius: f64, minor_radius: f64 };
    /// A cylinder of the given height with a hemisphere on each end.
    Capsule = "capsule" { radius: f64, height: f64 };
}

impl Amount {
    /// The mass of a volume; `name` is the solid's, for errors.
    pub(crate) fn mass(self, volume: Option<f64>, name: &'static str) -> Result<f64, BodyError> {
        let mass = match self {
            Amount::Mass(m) => m,
            Amount::Density(d) if !(d > 0.0 && d.is_finite()) => return Err(BodyError::Density(d)),
            Amount::Density(d) => d * volume.ok_or(BodyError::NoVolume { solid: name })?,
        };
        if mass > 0.0 && mass.is_finite() { Ok(mass) } else { Err(BodyError::Mass(mass)) }
    }
}

impl Solid {
    /// The solid of a kind, by its name in scenes, that fills a box of these side lengths; None for an unknown name.
    pub fn filling(kind: &str, [x, y, z]: [f64; 3]) -> Option<Solid> {
        let [radius, mean] = [0.25 * (x + y), (x + y + z) / 3.0];
        Some(match kind {
            "box" => Solid::Box { lengths: [x, y, z] },
            "ellipsoid" => Solid::Ellipsoid { semi_axes: [0.5 * x, 0.5 * y, 0.5 * z] },
            "sphere" => Solid::Sphere { radius: 0.5 * mean },
            "hollow_sphere" => Solid::HollowSphere { outer_radius: 0.5 * mean, inner_radius: 0.375 * mean },
            "cylinder" => Solid::Cylinder { radius, height: z },
            "cone" => Solid::Cone { radius, height: z },
            "capsule" => Solid::Capsule { radius, height: (z - 2.0 * radius).max(0.1 * radius) },
            "rod" => Solid::Rod { length: x.max(y).max(z) },
            "disc" => Solid::Disc { radius },
            "torus" => {
                let minor_radius = (0.5 * z).min(radius / 3.0);
                Solid::Torus { major_radius: radius - minor_radius, minor_radius }
            }
            _ => return None,
        })
    }

    /// The solid as a body, its centre of mass on the axis e3.
    pub fn body(self, amount: Amount) -> Result<Body, BodyError> {
        self.check()?;
        let mass = amount.mass(self.volume(), self.name())?;
        let moments = self.gyration_squared().map(|k| mass * k);
        Body::extended(mass, Inertia::from_principal_moments(moments)?, self.center())
    }

    /// The volume in m³; None for a rod, a disc, a thin shell and invalid lengths.
    pub fn volume(self) -> Option<f64> {
        self.check().ok()?;
        match self {
            Solid::Box { lengths: [a, b, c] } => Some(a * b * c),
            Solid::Ellipsoid { semi_axes: [a, b, c] } => Some(4.0 / 3.0 * PI * a * b * c),
            Solid::Sphere { radius: r } => Some(4.0 / 3.0 * PI * r * r * r),
            Solid::HollowSphere { outer_radius: r, inner_radius: s } => {
                // r³ − s³ without cancellation.
                (r > s).then(|| 4.0 / 3.0 * PI * (r - s) * (r * r + r * s + s * s))
            }
            Solid::Cylinder { radius: r, height: h } => Some(PI * r * r * h),
            Solid::Cone { radius: r, height: h } => Some(PI / 3.0 * r * r * h),
            Solid::Rod { .. } | Solid::Disc { .. } => None,
            // Pappus: the area of the tube's section times the path of its centre.
            Solid::Torus { major_radius: a, minor_radius: r } => Some(2.0 * PI * PI * a * r * r),
            Solid::Capsule { radius: r, height: h } => Some(PI * r * r * (h + 4.0 / 3.0 * r)),
        }
    }

    /// The squared radii of gyration `i_k / m` about the centre of mass.
    fn gyration_squared(self) -> [f64; 3] {
        let about_e3 = |across: f64, along: f64| [across, across, along];
        match self {
            Solid::Box { lengths: [a, b, c] } => {
                [(b * b + c * c) / 12.0, (c * c + a * a) / 12.0, (a * a + b * b) / 12.0]
            }
            Solid::Ellipsoid { semi_axes: [a, b, c] } => {
                [(b * b + c * c) / 5.0, (c * c + a * a) / 5.0, (a * a + b * b) / 5.0]
            }
            Solid::Sphere { radius: r } => [0.4 * r * r; 3],
            Solid::HollowSphere { outer_radius: r, inner_radius: s } => {
                // ⅖ (r⁵ − s⁵)/(r³ − s³) with r − s divided out; q = s/r.
                let q = s / r;
                let (fifth, third) = (1.0 + q * (1.0 + q * (1.0 + q * (1.0 + q))), 1.0 + q * (1.0 + q));
                [0.4 * r * r * (fifth / third); 3]
            }
            Solid::Cylinder { radius: r, height: h } => about_e3((3.0 * r * r + h * h) / 12.0, 0.5 * r * r),
            Solid::Cone { radius: r, height: h } => about_e3(0.15 * r * r + 0.0375 * h * h, 0.3 * r * r),
            Solid::Rod { length } => about_e3(length * length / 12.0, 0.0),
            Solid::Disc { radius: r } => about_e3(0.25 * r * r, 0.5 * r * r),
            Solid::Torus { major_radius: a, minor_radius: r } => {
                about_e3(0.5 * a * a + 0.625 * r * r, a * a + 0.75 * r * r)
            }
            Solid::Capsule { radius: r, height: h } => {
                // Shares of the two hemispheres and of the cylinder between them. A hemisphere's centre
                // of mass is 3r/8 beyond its base, which lies h/2 from the middle.
                let ends = 4.0 * r / (4.0 * r + 3.0 * h);
                let barrel = 3.0 * h / (4.0 * r + 3.0 * h);
                about_e3(
                    barrel * (3.0 * r * r + h * h) / 12.0
                        + ends * (0.4 * r * r + 0.25 * h * h + 0.375 * r * h),
                    barrel * 0.5 * r * r + ends * 0.4 * r * r,
                )
            }
        }
    }

    /// The centre of mass: the origin, or for a cone a quarter of the way to its apex.
    fn center(self) -> Vector {
        match self {
            Solid::Cone { height, .. } => Vector([0.0, 0.0, 0.25 * height]),
            _ => Vector::default(),
        }
    }

    /// The name of a solid that may lack a volume, for errors.
    fn name(self) -> &'static str {
        match self {
            Solid::HollowSphere { .. } => "hollow sphere with equal radii",
            Solid::Rod { .. } => "rod",
            Solid::Disc { .. } => "disc",
            _ => "solid",
        }
    }

    /// Checks that every length is positive and finite, a torus does not intersect itself, and a cavity fits.
    fn check(self) -> Result<(), BodyError> {
        let lengths: &[(&'static str, f64)] = match self {
            Solid::Box { lengths: [a, b, c] } => &[("lengths[0]", a), ("lengths[1]", b), ("lengths[2]", c)],
            Solid::Ellipsoid { semi_axes: [a, b, c] } => {
                &[("semi_axes[0]", a), ("semi_axes[1]", b), ("semi_axes[2]", c)]
            }
            Solid::Sphere { radius } | Solid::Disc { radius } => &[("radius", radius)],
            Solid::HollowSphere { outer_radius, .. } => &[("outer_radius", outer_radius)],
            Solid::Cylinder { radius, height }
            | Solid::Cone { radius, height }
            | Solid::Capsule { radius, height } => &[("radius", radius), ("height", height)],
            Solid::Rod { length } => &[("length", length)],
            Solid::Torus { major_radius, minor_radius } => {
                &[("major_radius", major_radius), ("minor_radius", minor_radius)]
            }
        };
        if let Some(&(name, value)) = lengths.iter().find(|(_, x)| !(*x > 0.0 && x.is_finite())) {
            return Err(BodyError::Length { name, value });
        }
        match self {
            Solid::HollowSphere { outer_radius: outer, inner_radius: inner }
                if !(0.0..=outer).contains(&inner) =>
            {
                Err(BodyError::InnerRadius { inner, outer })
            }
            Solid::Torus { major_radius: major, minor_radius: minor } if minor > major => {
                Err(BodyError::SpindleTorus { major, minor })
            }
            _ => Ok(()),
        }
    }
}
