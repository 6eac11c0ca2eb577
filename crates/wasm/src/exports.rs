//! Functions exported to JavaScript.
//!
//! A call takes its arguments from the [`room`]s filled before it, in order, and leaves [`reply_size`] bytes at
//! [`reply`]. It returns 0 or a handle, or −1 if the reply is an error message. No pointer from JavaScript is
//! dereferenced, and the core owns all memory. The page has one thread.

// `no_mangle` is unsafe because two crates might export the same name.
#![allow(unsafe_code)]

use crate::about::{about, solid as solid_json};
use crate::acting::acting as acting_json;
use crate::formulas;
use crate::laws;
use crate::merged::merged;
use crate::opened::crowd::Slice;
use crate::opened::{self, Files, Opened};
use crate::recorded::Recorded;
use crate::rows::ROW;
use polhode_ga::g3::attitude::EulerSequence;
use polhode_ga::{Rotor, Vector};
use polhode_rigid::{Inertia, Solid, Surface};
use std::cell::RefCell;

/// A motion that the page shows.
enum Loaded {
    Computed(Box<Opened>),
    Recorded(Recorded, Option<Surface>),
}

#[derive(Default)]
struct State {
    /// Arguments of the next call.
    rooms: Vec<Vec<u8>>,
    reply: Vec<u8>,
    motions: Vec<Option<Loaded>>,
}

thread_local! {
    static STATE: RefCell<State> = RefCell::default();
}

type Outcome<T> = Result<T, String>;

mod clock {
    #[cfg(target_arch = "wasm32")]
    #[link(wasm_import_module = "page")]
    unsafe extern "C" {
        /// Seconds since a fixed instant.
        safe fn now() -> f64;
    }

    /// Seconds since a fixed instant.
    pub fn seconds() -> f64 {
        #[cfg(target_arch = "wasm32")]
        return now();
        #[cfg(not(target_arch = "wasm32"))]
        {
            use std::sync::OnceLock;
            use std::time::Instant;
            static START: OnceLock<Instant> = OnceLock::new();
            START.get_or_init(Instant::now).elapsed().as_secs_f64()
        }
    }
}

/// Returns whether a budget in seconds, counted from now, is left.
fn within(budget: f64) -> impl FnMut() -> bool {
    let end = clock::seconds() + budget;
    move || clock::seconds() < end
}

/// Allocates an argument of the next call, of `size` bytes.
#[unsafe(no_mangle)]
pub extern "C" fn room(size: usize) -> *mut u8 {
    STATE.with_borrow_mut(|state| {
        state.rooms.push(vec![0; size]);
        state.rooms.last_mut().map_or(std::ptr::null_mut(), |room| room.as_mut_ptr())
    })
}

/// Address of the last reply.
#[unsafe(no_mangle)]
pub extern "C" fn reply() -> *const u8 {
    STATE.with_borrow(|state| state.reply.as_ptr())
}

/// Size of the last reply in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn reply_size() -> usize {
    STATE.with_borrow(|state| state.reply.len())
}

/// Runs a call with its arguments and stores its reply.
fn reply_with(work: impl FnOnce(&mut State, Vec<Vec<u8>>) -> Outcome<(i32, Vec<u8>)>) -> i32 {
    STATE.with_borrow_mut(|state| {
        let rooms = std::mem::take(&mut state.rooms);
        let (code, reply) = work(state, rooms).unwrap_or_else(|problem| (-1, problem.into_bytes()));
        state.reply = reply;
        code
    })
}

fn text(bytes: Option<Vec<u8>>) -> Outcome<String> {
    String::from_utf8(bytes.unwrap_or_default()).map_err(|_| "not UTF-8 text".to_owned())
}

fn floats(bytes: &[u8]) -> Vec<f64> {
    bytes.as_chunks().0.iter().map(|eight| f64::from_le_bytes(*eight)).collect()
}

/// Exactly N numbers from the first room.
fn numbers<const N: usize>(rooms: &[Vec<u8>]) -> Outcome<[f64; N]> {
    let found = floats(rooms.first().map_or(&[], |room| room));
    found.try_into().map_err(|found: Vec<f64>| format!("expected {N} numbers, got {}", found.len()))
}

fn bytes(numbers: impl IntoIterator<Item = f64>) -> Vec<u8> {
    numbers.into_iter().flat_map(f64::to_le_bytes).collect()
}

/// The remaining arguments: a scene, its name, and files, each after its name.
fn scene(mut rooms: impl Iterator<Item = Vec<u8>>) -> Outcome<(String, String, Files)> {
    let (scene, name) = (text(rooms.next())?, text(rooms.next())?);
    let mut files = Files::new();
    while let (Some(name), Some(content)) = (rooms.next(), rooms.next()) {
        files.insert(text(Some(name))?, content);
    }
    Ok((scene, name, files))
}

const RECORDED: &str = "this motion is a recording";

fn unknown(handle: usize) -> String {
    format!("no motion has the handle {handle}")
}

impl State {
    fn add(&mut self, motion: Loaded) -> i32 {
        let free = self.motions.iter().position(Option::is_none);
        let place = free.unwrap_or_else(|| {
            self.motions.push(None);
            self.motions.len() - 1
        });
        self.motions[place] = Some(motion);
        place as i32
    }

    fn get(&self, handle: usize) -> Outcome<&Loaded> {
        self.motions.get(handle).and_then(Option::as_ref).ok_or_else(|| unknown(handle))
    }

    fn computed(&self, handle: usize) -> Outcome<&Opened> {
        match self.get(handle)? {
            Loaded::Computed(opened) => Ok(opened),
            Loaded::Recorded(..) => Err(RECORDED.to_owned()),
        }
    }

    fn computed_mut(&mut self, handle: usize) -> Outcome<&mut Opened> {
        match self.motions.get_mut(handle) {
            Some(Some(Loaded::Computed(opened))) => Ok(opened),
            Some(Some(Loaded::Recorded(..))) => Err(RECORDED.to_owned()),
            _ => Err(unknown(handle)),
        }
    }

    /// The surface of a body. If its scene has none, it is computed from the numbers in the room: the mass, the principal
    /// moments, the principal frame, and the arm from the fixed point to the centre of mass.
    fn surface(&self, handle: usize, rooms: &[Vec<u8>]) -> Outcome<Surface> {
        let [mass, i1, i2, i3, f0, f1, f2, f3, arm @ ..] = numbers::<11>(rooms)?;
        let known = match self.get(handle)? {
            Loaded::Computed(opened) => &opened.surface,
            Loaded::Recorded(_, surface) => surface,
        };
        let frame = Rotor::from_unit_components([f0, f1, f2, f3]);
        Ok(known.clone().unwrap_or_else(|| Surface::of_inertia(mass, [i1, i2, i3], frame, Vector(arm))))
    }
}

/// Takes a scene, its name and files; computes the motion for at most `budget` seconds; returns a handle.
#[unsafe(no_mangle)]
pub extern "C" fn open(budget: f64) -> i32 {
    reply_with(|state, rooms| {
        let (scene, name, files) = scene(rooms.into_iter())?;
        let opened = Opened::new(&scene, &name, &files, &mut within(budget))?;
        Ok((state.add(Loaded::Computed(Box::new(opened))), Vec::new()))
    })
}

/// Takes rows of a recorded motion and, if there is one, the scene, its name and files; returns a handle.
#[unsafe(no_mangle)]
pub extern "C" fn record() -> i32 {
    reply_with(|state, rooms| {
        let mut rooms = rooms.into_iter();
        let recorded = Recorded::new(&floats(&rooms.next().unwrap_or_default()))?;
        let (scene, name, files) = scene(rooms)?;
        Ok((state.add(Loaded::Recorded(recorded, opened::surface(&scene, &name, &files))), Vec::new()))
    })
}

/// Frees a motion.
#[unsafe(no_mangle)]
pub extern "C" fn close(handle: usize) {
    STATE.with_borrow_mut(|state| {
        if let Some(motion) = state.motions.get_mut(handle) {
            *motion = None;
        }
    });
}

/// The facts of a motion, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn about_motion(handle: usize) -> i32 {
    reply_with(|state, _| Ok((0, about(state.computed(handle)?).to_string().into_bytes())))
}

/// Takes times; replies with rows of states.
#[unsafe(no_mangle)]
pub extern "C" fn states(handle: usize) -> i32 {
    reply_with(|state, rooms| {
        let times = floats(rooms.first().map_or(&[], |room| room));
        let rows: Vec<[f64; ROW]> = match state.get(handle)? {
            Loaded::Computed(opened) => opened.states(&times)?,
            Loaded::Recorded(recorded, _) => recorded.states(&times)?,
        };
        Ok((0, bytes(rows.into_iter().flatten())))
    })
}

/// Takes a row of states; replies with what acts on the body in that state, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn acting(handle: usize) -> i32 {
    reply_with(|state, rooms| {
        let found = acting_json(state.computed(handle)?, numbers(&rooms)?)?;
        Ok((0, found.to_string().into_bytes()))
    })
}

/// Takes the numbers of [`State::surface`]; replies with the vertices of the surface in body axes, in m, its triangles as 32-bit
/// indices, and a 32-bit tint per triangle. Returns the number of vertices.
#[unsafe(no_mangle)]
pub extern "C" fn surface(handle: usize) -> i32 {
    reply_with(|state, rooms| {
        let Surface { vertices, faces, tints } = state.surface(handle, &rooms)?;
        let mut reply = bytes(vertices.iter().flat_map(|vertex| vertex.0));
        reply.extend(faces.iter().flatten().chain(&tints).flat_map(|number| number.to_le_bytes()));
        Ok((vertices.len() as i32, reply))
    })
}

/// Takes the numbers of [`State::surface`]; replies with the side lengths of a box around the body, in m.
#[unsafe(no_mangle)]
pub extern "C" fn extents(handle: usize) -> i32 {
    reply_with(|state, rooms| Ok((0, bytes(state.surface(handle, &rooms)?.extents()))))
}

/// Takes the kind of a solid and three lengths; replies with the solid that fills a box of these sides, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn solid() -> i32 {
    reply_with(|_, rooms| {
        let mut rooms = rooms.into_iter();
        let kind = text(rooms.next())?;
        let solid = Solid::filling(&kind, numbers(rooms.as_slice())?);
        let solid = solid.ok_or_else(|| format!("there is no solid of kind '{kind}'"))?;
        Ok((0, solid_json(solid).to_string().into_bytes()))
    })
}

/// Takes principal moments and the principal frame; replies with the second moments and, unless these are along the body
/// axes, the rotor from their axes to the body axes.
#[unsafe(no_mangle)]
pub extern "C" fn second_moments() -> i32 {
    reply_with(|_, rooms| {
        let [i1, i2, i3, frame @ ..] = numbers::<7>(&rooms)?;
        let inertia = Inertia::from_principal_moments([i1, i2, i3]).map_err(|error| error.to_string())?;
        let (second, axes) = inertia.rotated(Rotor::from_unit_components(frame)).second_moments();
        Ok((0, bytes(second.into_iter().chain(axes.into_iter().flat_map(Rotor::components)))))
    })
}

/// Takes second moments and the rotor from their axes to the body axes; replies with the rows of the inertia matrix.
#[unsafe(no_mangle)]
pub extern "C" fn inertia() -> i32 {
    reply_with(|_, rooms| {
        let [a, b, c, axes @ ..] = numbers::<7>(&rooms)?;
        let inertia = Inertia::from_second_moments([a, b, c], Rotor::from_unit_components(axes));
        Ok((0, bytes(inertia.map_err(|error| error.to_string())?.matrix().into_iter().flatten())))
    })
}

/// Takes a rotor; replies with its angles for [`EulerSequence::ZXZ`].
#[unsafe(no_mangle)]
pub extern "C" fn attitude() -> i32 {
    reply_with(|_, rooms| {
        let rotor = Rotor::from_unit_components(numbers(&rooms)?);
        Ok((0, bytes(EulerSequence::ZXZ.angles(rotor).into_iter().flatten())))
    })
}

/// Takes a rotor; replies with the unit plane and the angle of [`Rotor::plane_angle`].
#[unsafe(no_mangle)]
pub extern "C" fn plane_angle() -> i32 {
    reply_with(|_, rooms| {
        let (plane, angle) = Rotor::from_unit_components(numbers(&rooms)?).plane_angle();
        Ok((0, bytes(plane.0.into_iter().chain([angle]))))
    })
}

/// Rotors of the first bodies of an ensemble, at most `count`, at a time, with NaN for those that are not known. The first
/// call computes their motions, for at most `budget` seconds, unless they were [`join`]ed.
#[unsafe(no_mangle)]
pub extern "C" fn bodies(handle: usize, time: f64, count: usize, budget: f64) -> i32 {
    reply_with(|state, _| {
        let crowd = state.computed(handle)?.bodies(count, &mut within(budget))?;
        Ok((0, bytes(crowd.at(time).into_iter().flatten())))
    })
}

/// Why the first of the computed [`bodies`] that are not known is not, with its number; empty if all are.
#[unsafe(no_mangle)]
pub extern "C" fn bodies_problem(handle: usize) -> i32 {
    reply_with(|state, _| match state.get(handle)? {
        Loaded::Computed(opened) => Ok((0, opened.bodies_problem().into())),
        Loaded::Recorded(..) => Ok((0, Vec::new())),
    })
}

/// Computes the bodies of an ensemble without a closed form from number `from` up to `to`, for at most `budget` seconds.
/// Replies with their rotors for [`join`], then with the text of [`bodies_problem`]; returns where the text begins.
#[unsafe(no_mangle)]
pub extern "C" fn slice(handle: usize, from: usize, to: usize, budget: f64) -> i32 {
    reply_with(|state, _| {
        let slice = Slice::new(state.computed(handle)?, from..to, &mut within(budget))?;
        let mut reply = bytes(slice.rotors.into_iter().flatten());
        let size = reply.len();
        reply.extend(slice.problem.into_bytes());
        Ok((size as i32, reply))
    })
}

/// Takes the text of [`bodies_problem`], and the rotors of consecutive [`slice`]s from the first body on, which another
/// core may have computed; they are the bodies of the motion from now on.
#[unsafe(no_mangle)]
pub extern "C" fn join(handle: usize) -> i32 {
    reply_with(|state, rooms| {
        let mut rooms = rooms.into_iter();
        let problem = text(rooms.next())?;
        let rotors = rooms.flat_map(|room| floats(&room).as_chunks().0.to_vec()).collect();
        state.computed_mut(handle)?.join(Slice { rotors, problem });
        Ok((0, Vec::new()))
    })
}

/// Takes a scene and tables; replies with the scene with these tables replaced.
#[unsafe(no_mangle)]
pub extern "C" fn merge() -> i32 {
    reply_with(|_, rooms| {
        let mut rooms = rooms.into_iter();
        let (scene, change) = (text(rooms.next())?, text(rooms.next())?);
        Ok((0, merged(&scene, &change)?.into_bytes()))
    })
}

/// Takes lines of formulas; replies with their results, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn evaluate() -> i32 {
    reply_with(|_, rooms| {
        let lines = text(rooms.into_iter().next())?;
        Ok((0, formulas::evaluated(&lines).into_bytes()))
    })
}

/// The registry of laws, as JSON.
#[unsafe(no_mangle)]
pub extern "C" fn law_registry() -> i32 {
    reply_with(|_, _| Ok((0, laws::laws().to_string().into_bytes())))
}
