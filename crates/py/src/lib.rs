//! Python binding: converts arrays, registers functions and releases the GIL.

use pyo3::prelude::*;

mod algebra;
mod formula;
mod mechanics;
mod scene;
mod support;

/// The compiled core of Polhode; private, called through `polhode`.
#[pymodule]
mod _native {
    use polhode_ga::formula::session;

    #[pymodule_export]
    use crate::algebra::attitude::{
        distance_between, rotor_between, rotor_canonical, rotor_from, rotor_from_euler, rotor_from_turn,
        rotor_to, rotor_to_euler, rotor_to_power, slerp_between,
    };
    #[pymodule_export]
    use crate::algebra::batch::{norm_of, norm_squared, normalized};
    #[pymodule_export]
    use crate::algebra::rows::{
        from_pauli, function, motor_function, motor_normalize, norm, product, rotor_apply, rotor_compose,
        rotor_distance, rotor_exp, rotor_from_components, rotor_from_matrix, rotor_from_plane_angle,
        rotor_from_quaternion, rotor_from_rotation_vector, rotor_from_vectors, rotor_log, rotor_plane_angle,
        rotor_power, rotor_to_matrix, rotor_to_quaternion, rotor_to_rotation_vector, subspaces, to_pauli,
        units_and_sizes, versor_apply, with_signs,
    };

    #[pymodule_export]
    use crate::mechanics::bodies::{Body, Inertia, types_of};
    #[pymodule_export]
    use crate::mechanics::ensemble::simulate_many;
    #[pymodule_export]
    use crate::mechanics::flow::{free_flow, free_flow_derivatives};
    #[pymodule_export]
    use crate::mechanics::forces_and_events::{Event, Force, law_registry};
    #[pymodule_export]
    use crate::mechanics::free::FreeMotion;
    #[pymodule_export]
    use crate::mechanics::law_value::LawValue;
    #[pymodule_export]
    use crate::mechanics::simulation::{Motion, methods, simulate};
    #[pymodule_export]
    use crate::mechanics::stepper::Stepper;
    #[pymodule_export]
    use crate::mechanics::surfaces::{read_mesh, solid_surface};

    #[pymodule_export]
    use crate::mechanics::closed_form::ClosedForm;
    #[pymodule_export]
    use crate::mechanics::closed_forms::{LagrangeTop, damped_tops, larmor_spheres, symmetric_top};
    #[pymodule_export]
    use crate::mechanics::torque::{Law, dipole_fields, orbit_directions, orbit_positions, torque_at};

    #[pymodule_export]
    use crate::formula::Formula;
    #[pymodule_export]
    use crate::formula::line::SessionLine;
    #[pymodule_export]
    use crate::formula::program::{Program, agreement_tolerance, canonical, marked};

    #[pymodule_export]
    use crate::algebra::signature::{Algebra, g3_object};
    #[pymodule_export]
    use crate::algebra::single::{are_close, normalized_motor, number_of, unit_and_size, versor_action};
    #[pymodule_export]
    use crate::support::pool::{Buffer, buffer};
    #[pymodule_export]
    use crate::support::python_objects::register;

    #[pymodule_export]
    use crate::scene::{BinCounts, Scene, SceneError, kept_words, regimes};
    #[pymodule_export]
    use crate::support::text::diagnostic;

    #[pymodule_export]
    const EQUATION_AS_VALUE: &str = session::EQUATION_AS_VALUE;
    #[pymodule_export]
    const LAST_VALUE: &str = session::LAST_VALUE;
    #[pymodule_export]
    const NO_LAST_VALUE: &str = session::NO_LAST_VALUE;
    #[pymodule_export]
    const NOT_FINITE: &str = session::NOT_FINITE;

    /// Adds the types of values and of calls, which are not classes of pyo3.
    #[pymodule_init]
    fn init(module: &pyo3::Bound<'_, pyo3::types::PyModule>) -> pyo3::PyResult<()> {
        use pyo3::types::PyModuleMethods as _;

        let [multivector, rotor] = crate::algebra::slots::create_types(module.py())?;
        module.add("Multivector", multivector)?;
        module.add("Rotor", rotor)?;
        module.add("FormulaCaller", crate::formula::caller::create_type(module.py())?)
    }

    /// The version of the package.
    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
