//! A solved state as it stands in the page: fields of bodies and contacts, tables.

use serde::Serialize;

use super::PageState;
use super::packed::Packed;
use super::skin::Skin;
use super::surface::padded;
use super::words::{self, Law, Row};
use crate::report::{Contact, ReportedContactState, ReportedStatus};

/// A state.
#[derive(Debug, Serialize)]
pub(super) struct DrawnState<'a> {
    /// Number and instant of the load step; none where the scene has no steps.
    #[serde(skip_serializing_if = "Option::is_none")]
    step: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    at: Option<f64>,
    status: ReportedStatus,
    /// The status as a sentence, and with it what to do where there is no certificate.
    words: Vec<String>,
    totals: Vec<Row>,
    laws: Vec<Law>,
    notes: &'a [String],
    bodies: Vec<BodyState>,
    contacts: ContactState,
    /// Motion of the obstacle of every pair.
    obstacles: Vec<DrawnMotion>,
}

/// Translation in metre, rotation in radian, and the point that it is about, relative to the scene's origin.
#[derive(Debug, Serialize)]
struct DrawnMotion {
    translation: [f64; 3],
    rotation: [f64; 3],
    about: [f64; 3],
}

/// Fields at the drawn points of a body.
#[derive(Debug, Serialize)]
struct BodyState {
    /// A component per axis, in metre.
    displacement: Packed,
    /// xx, yy, zz, xy, and in 3D then yz, xz, in pascal.
    stress: Packed,
}

/// Fields of the contacts; vectors have a component per axis.
#[derive(Debug, Serialize)]
struct ContactState {
    pressure: Packed,
    friction: Packed,
    gap: Packed,
    initial_gap: Packed,
    slip: Packed,
    /// 0 open, 1 slip, 2 stick.
    state: Packed,
    /// Coefficient of friction.
    coefficient: Packed,
}

impl<'a> DrawnState<'a> {
    pub(super) fn new(parts: &PageState<'a>, skins: &[Skin], origin: [f64; 3]) -> Self {
        let report = parts.report;
        let bodies = parts.displacements.iter().zip(parts.stresses).zip(skins);
        let dimension = report.size.dimension;
        let bodies = bodies.map(|((displacement, stress), skin)| match dimension {
            2 => BodyState {
                displacement: of_points::<2>(skin, displacement),
                stress: Packed::reals(
                    skin.points
                        .means(|node| {
                            let [xx, yy, zz, _, _, xy] = stress[node];
                            [xx, yy, zz, xy]
                        })
                        .flatten(),
                ),
            },
            _ => BodyState {
                displacement: of_points::<3>(skin, displacement),
                stress: Packed::reals(
                    skin.points
                        .means(|node| {
                            let [xx, yy, zz, yz, xz, xy] = stress[node];
                            [xx, yy, zz, xy, yz, xz]
                        })
                        .flatten(),
                ),
            },
        });
        let step = report.step.as_ref();
        Self {
            step: step.map(|step| step.number),
            at: step.map(|step| step.at),
            status: report.status,
            words: words::status(report),
            totals: words::totals(report),
            laws: words::laws(report),
            notes: &report.notes,
            bodies: bodies.collect(),
            contacts: ContactState::new(parts),
            obstacles: (parts.obstacles.iter())
                .map(|motion| DrawnMotion {
                    translation: motion.translation,
                    rotation: motion.rotation,
                    about: [0, 1, 2].map(|axis| motion.about[axis] - origin[axis]),
                })
                .collect(),
        }
    }
}

/// A displacement of `N` axes at the drawn points.
fn of_points<const N: usize>(skin: &Skin, displacement: &[f64]) -> Packed {
    let at = |node: usize| std::array::from_fn::<f64, N, _>(|axis| displacement[N * node + axis]);
    Packed::reals(skin.points.means(at).flatten())
}

impl ContactState {
    fn new(parts: &PageState<'_>) -> Self {
        let contacts = &parts.report.contacts;
        let axes = parts.report.size.dimension;
        let reals = |value: fn(&Contact) -> f64| Packed::reals(contacts.iter().map(value));
        let vectors = |value: fn(&Contact) -> [f64; 3]| {
            let values = contacts.iter().map(value);
            Packed::reals(values.flat_map(|vector| vector.into_iter().take(axes)))
        };
        let states = contacts.iter().map(|contact| match contact.state {
            ReportedContactState::Open => 0,
            ReportedContactState::Slip => 1,
            ReportedContactState::Stick => 2,
        });
        Self {
            pressure: reals(|contact| contact.pressure.unwrap_or(f64::NAN)),
            friction: vectors(|contact| {
                let friction = contact.friction_traction.as_deref();
                friction.map_or([f64::NAN; 3], padded)
            }),
            gap: reals(|contact| contact.gap),
            initial_gap: Packed::reals(parts.initial_gap.iter().copied()),
            slip: vectors(|contact| padded(&contact.slip)),
            state: Packed::integers(states),
            coefficient: Packed::reals(parts.friction.iter().copied()),
        }
    }
}
