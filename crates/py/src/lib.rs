//! The Python binding: converts arrays, registers functions, releases the GIL. It holds no formula.

use pyo3::prelude::*;

mod algebra;
mod arrays;
mod batches;
mod bodies;
mod calls;
mod closed_forms;
mod columns;
mod draws;
mod ensemble;
mod flow;
mod formula;
mod free;
mod laws;
mod made;
mod motion;
mod multivector;
mod operators;
mod pool;
mod program;
mod scene;
mod signature;
mod simulation;
mod text;
mod torque;
mod value;

/// The compiled core of Polhode; private, called through `polhode`.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::algebra::{
        from_pauli, function, norm, product, rotor_apply, rotor_compose, rotor_exp, rotor_from_components,
        rotor_from_matrix, rotor_from_plane_angle, rotor_from_quaternion, rotor_from_rotation_vector,
        rotor_from_vectors, rotor_log, rotor_plane_angle, rotor_power, rotor_to_matrix, rotor_to_quaternion,
        rotor_to_rotation_vector, subspaces, to_pauli,
    };

    #[pymodule_export]
    use crate::bodies::{Body, Inertia};
    #[pymodule_export]
    use crate::ensemble::simulate_many;
    #[pymodule_export]
    use crate::flow::{free_flow, free_flow_derivatives};
    #[pymodule_export]
    use crate::free::FreeMotion;
    #[pymodule_export]
    use crate::laws::{Event, Force};
    #[pymodule_export]
    use crate::made::Made;
    #[pymodule_export]
    use crate::motion::symmetric_top;
    #[pymodule_export]
    use crate::simulation::{Motion, methods, simulate};

    #[pymodule_export]
    use crate::closed_forms::{DampedTop, LagrangeTop, LarmorSphere};
    #[pymodule_export]
    use crate::torque::{Law, orbit_directions, torque_at};

    #[pymodule_export]
    use crate::formula::Formula;
    #[pymodule_export]
    use crate::program::{Program, canonical, marked};

    #[pymodule_export]
    use crate::pool::{Buffer, buffer};
    #[pymodule_export]
    use crate::signature::{Algebra, g3_object};
    #[pymodule_export]
    use crate::value::{Multivector, Rotor};

    #[pymodule_export]
    use crate::draws::Draws;
    #[pymodule_export]
    use crate::scene::{SceneError, read_scene, scene_mesh};
    #[pymodule_export]
    use crate::text::{diagnostic, near_unit, quantities};

    /// The version of the package.
    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
