//! The processes of an MPI run: rank 0 solves, the others hold their part of every factor and wait to be asked.

use std::sync::{Mutex, MutexGuard, PoisonError};

use super::entries::Entries;
use super::factorisation::factorise;
use super::{World, mark};
use crate::body::Body;
use crate::condensation::ordering::{HELD, Ordering};
use crate::error::Error;

/// The world while somebody is in it: one thread at a time.
static WORLD: Mutex<Option<World>> = Mutex::new(None);

/// A request in numbers.
type Words = [i32; 6];

/// What rank 0 asks of the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Request {
    /// To factorise a body: number of its unknowns, of rows of its border, and what marks it.
    Factorise([i32; 5]),
    /// To solve with an instance, in a way that MUMPS numbers.
    Solve([i32; 2]),
    /// To free an instance.
    Free(i32),
    /// To leave.
    Leave,
}

impl Request {
    fn words(self) -> Words {
        match self {
            Self::Factorise([body, unknowns, border, high, low]) => {
                [0, body, unknowns, border, high, low]
            }
            Self::Solve([number, way]) => [1, number, way, 0, 0, 0],
            Self::Free(number) => [2, number, 0, 0, 0, 0],
            Self::Leave => [3, 0, 0, 0, 0, 0],
        }
    }

    fn new([what, a, b, c, d, e]: Words) -> Self {
        match what {
            0 => Self::Factorise([a, b, c, d, e]),
            1 => Self::Solve([a, b]),
            2 => Self::Free(a),
            _ => Self::Leave,
        }
    }

    /// Asks from rank 0.
    pub(super) fn ask(self, world: &mut World) {
        world.tell(&mut self.words());
    }

    /// Waits for it on another rank.
    fn wait(world: &mut World) -> Self {
        let mut words = Words::default();
        world.tell(&mut words);
        Self::new(words)
    }
}

fn world() -> MutexGuard<'static, Option<World>> {
    WORLD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What `work` makes of the world; none once all have left.
pub(super) fn with<T>(work: impl FnOnce(&mut World) -> T) -> Option<T> {
    world().as_mut().map(work)
}

/// The processes that `mpirun` started together, among which [`Engine::Mumps`](crate::Engine) divides the factors
/// of bodies. Every process joins; rank 0 solves as if it were alone, the others [`serve`](Self::serve) it until
/// it drops what it joined with.
///
/// ```no_run
/// use dpana::{Engine, Ranks, Scene, solve};
///
/// # fn main() -> Result<(), dpana::Error> {
/// let ranks = Ranks::join()?;
/// let mut scene = Scene::from_file("cube.json")?;
/// if ranks.rank() > 0 {
///     ranks.serve(scene.mechanics().map(|mechanics| mechanics.bodies));
///     return Ok(());
/// }
/// scene.settings.engine = Engine::Mumps;
/// let solution = solve(&scene)?;
/// println!("{:?} on {} ranks", solution.status(), ranks.count());
/// # Ok(())
/// # }
/// ```
#[derive(Debug)]
pub struct Ranks {
    rank: usize,
    count: usize,
}

impl Ranks {
    /// Begins MPI, once in a process. Outside of `mpirun` there is one rank.
    ///
    /// # Errors
    ///
    /// [`Error::NotAccepted`] where this build holds no MUMPS, with what to install, where MPI was begun before, or
    /// where it does not let several threads call it in turn.
    pub fn join() -> Result<Self, Error> {
        let joined = World::join().map_err(|found| Error::NotAccepted {
            place: "engine".to_owned(),
            found,
            accepted: "a build with `--features mumps` where MUMPS and MPI are installed (Debian: \
                       libmumps-dev, libopenmpi-dev, openmpi-bin), and one `Ranks` in a process"
                .to_owned(),
        })?;
        let ranks = Self {
            rank: joined.rank(),
            count: joined.count(),
        };
        *world() = Some(joined);
        Ok(ranks)
    }

    /// Number of this process, from 0.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.rank
    }

    /// Number of processes.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Holds a part of the factors of bodies until rank 0 leaves. `bodies` are those of the scene that rank 0
    /// solves, or why there are none: rank 0 then says so.
    ///
    /// On rank 0 there is nobody to serve.
    pub fn serve(self, bodies: Result<Vec<Body>, impl std::fmt::Display>) {
        if self.rank == 0 {
            return;
        }
        let bodies = bodies.map_err(|error| error.to_string());
        with(|world| {
            loop {
                match Request::wait(world) {
                    Request::Factorise(of) => help(world, &bodies, of),
                    Request::Solve([number, way]) => {
                        world.solve(number as usize, way, &mut [], &mut []);
                    }
                    Request::Free(number) => world.free(number as usize),
                    Request::Leave => break,
                }
            }
        });
    }
}

impl Drop for Ranks {
    fn drop(&mut self) {
        let Some(mut leaving) = world().take() else {
            return;
        };
        if self.count > 1 && std::thread::panicking() {
            // The others would wait for this one for ever.
            leaving.abort();
        }
        if self.rank == 0 {
            Request::Leave.ask(&mut leaving);
        }
        leaving.leave();
    }
}

/// Takes part in a factorisation that rank 0 asked for.
fn help(
    world: &mut World,
    bodies: &Result<Vec<Body>, String>,
    [body, unknowns, border, high, low]: [i32; 5],
) {
    let mut dof = vec![0; unknowns as usize];
    world.tell(&mut dof);
    let part = bodies.as_ref().map_err(Clone::clone).and_then(|bodies| {
        let body = bodies.get(body as usize);
        let body = body.filter(|body| mark(body) == [high, low]);
        let body = body.ok_or("another scene than on rank 0")?;
        let share = (world.rank(), world.count());
        let entries = Entries::of_cells(body, share, &placed(&dof, body.unknowns()));
        entries.map_err(|error| error.to_string())
    });
    drop(dof);
    let size = (unknowns + border) as usize;
    // Rank 0 learns of a failure in the same call, and tells.
    let _ = factorise(world, part, (size, border as usize), &mut []);
}

/// An ordering from the degree of freedom at each position.
fn placed(dof: &[i32], unknowns: usize) -> Ordering {
    let dof: Vec<usize> = dof.iter().map(|&dof| dof as usize).collect();
    let mut position = vec![HELD; unknowns];
    dof.iter()
        .enumerate()
        .for_each(|(at, &dof)| position[dof] = at);
    Ordering {
        position,
        dof,
        contact_unknowns: 0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_come_through() {
        let all = [
            Request::Factorise([1, 2, 3, -4, 5]),
            Request::Solve([7, 2]),
            Request::Free(3),
            Request::Leave,
        ];
        for request in all {
            assert_eq!(Request::new(request.words()), request);
        }
    }
}
