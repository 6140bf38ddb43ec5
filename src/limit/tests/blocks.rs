//! Rigid blocks that the tests of this folder share: contact points in, modes out.

#![allow(clippy::unwrap_used)]

use faer::Mat;

use crate::limit::RigidContacts;

/// One contact point; the normal points out of the first body.
#[derive(Clone, Debug)]
pub(crate) struct Touch {
    pub(crate) point: [f64; 3],
    pub(crate) normal: [f64; 3],
    /// The body, and the one it touches; `None` for the ground.
    pub(crate) bodies: (usize, Option<usize>),
    pub(crate) friction: f64,
}

/// Rigid bodies that touch; modes per body are translations, then rotations about the origin.
#[derive(Clone, Debug)]
pub(crate) struct Blocks {
    pub(crate) dimension: usize,
    pub(crate) bodies: usize,
    pub(crate) touches: Vec<Touch>,
    pub(crate) tangents: bool,
}

impl Blocks {
    pub(crate) fn new(dimension: usize, bodies: usize, touches: Vec<Touch>) -> Self {
        Self {
            dimension,
            bodies,
            touches,
            tangents: true,
        }
    }

    /// A pad of 20 × 20 mm on a floor, touching at its corners, pressed along the last axis.
    pub(crate) fn pad(dimension: usize, friction: f64) -> Self {
        let mut touches = Vec::new();
        let depths: &[f64] = if dimension == 2 {
            &[0.0]
        } else {
            &[-0.01, 0.01]
        };
        for x in [-0.01, 0.01] {
            for &y in depths {
                let (point, normal) = if dimension == 2 {
                    ([x, 0.0, 0.0], [0.0, -1.0, 0.0])
                } else {
                    ([x, y, 0.0], [0.0, 0.0, -1.0])
                };
                touches.push(Touch {
                    point,
                    normal,
                    bodies: (0, None),
                    friction,
                });
            }
        }
        Self::new(dimension, 1, touches)
    }

    /// Every position in another unit.
    pub(crate) fn scale(&mut self, unit: f64) {
        for touch in &mut self.touches {
            touch.point = touch.point.map(|x| x * unit);
        }
    }

    pub(crate) fn contacts(&self) -> RigidContacts {
        let tangents = if self.tangents { self.dimension - 1 } else { 0 };
        let block = 1 + tangents;
        let count = self.touches.len();
        let mut modes = Mat::zeros(block * count, self.bodies * self.modes());
        for (i, touch) in self.touches.iter().enumerate() {
            for (row, axis) in frame(touch.normal, self.dimension)[..block]
                .iter()
                .enumerate()
            {
                let work = self.resultant(touch.point, *axis);
                for (k, entry) in work.iter().enumerate() {
                    modes[(block * i + row, touch.bodies.0 * self.modes() + k)] += entry;
                    if let Some(other) = touch.bodies.1 {
                        modes[(block * i + row, other * self.modes() + k)] -= entry;
                    }
                }
            }
        }
        let friction = self.touches.iter().map(|touch| touch.friction).collect();
        RigidContacts::new(&vec![tangents; count], friction, modes).unwrap()
    }

    /// Work of forces on each mode: `(body, force, point)`.
    pub(crate) fn load(&self, forces: &[(usize, [f64; 3], [f64; 3])]) -> Vec<f64> {
        let mut load = vec![0.0; self.bodies * self.modes()];
        for &(body, force, point) in forces {
            for (k, work) in self.resultant(point, force).iter().enumerate() {
                load[body * self.modes() + k] += work;
            }
        }
        load
    }

    fn modes(&self) -> usize {
        if self.dimension == 2 { 3 } else { 6 }
    }

    /// `(F, x × F)`.
    fn resultant(&self, x: [f64; 3], f: [f64; 3]) -> Vec<f64> {
        let moment = cross(x, f);
        if self.dimension == 2 {
            vec![f[0], f[1], moment[2]]
        } else {
            [f, moment].concat()
        }
    }
}

/// A block of unit weight on a slope: `(width, height)`, x down the slope, touching at the edges
/// of its base (and one point between), the last axis out of the slope.
pub(crate) fn incline(
    dimension: usize,
    friction: f64,
    slope: f64,
    [width, height]: [f64; 2],
) -> (RigidContacts, Vec<f64>) {
    let depths: &[f64] = if dimension == 2 { &[0.0] } else { &[-0.5, 0.5] };
    let mut touches = Vec::new();
    for x in [-0.5 * width, 0.1 * width, 0.5 * width] {
        for &y in depths {
            let (point, normal) = if dimension == 2 {
                ([x, 0.0, 0.0], [0.0, -1.0, 0.0])
            } else {
                // Up is y here as well, so that modes 0 and 1 are along and out of the slope.
                ([x, 0.0, y], [0.0, -1.0, 0.0])
            };
            touches.push(Touch {
                point,
                normal,
                bodies: (0, None),
                friction,
            });
        }
    }
    let blocks = Blocks::new(dimension, 1, touches);
    let a = slope.atan();
    let weight = blocks.load(&[(0, [a.sin(), -a.cos(), 0.0], [0.0, 0.5 * height, 0.0])]);
    (blocks.contacts(), weight)
}

/// A force along x and along the last axis.
pub(crate) fn force([along, up]: [f64; 2], dimension: usize) -> [f64; 3] {
    if dimension == 2 {
        [along, up, 0.0]
    } else {
        [along, 0.0, up]
    }
}

/// Normal and tangents; the first tangent is along x where it can be.
fn frame(normal: [f64; 3], dimension: usize) -> [[f64; 3]; 3] {
    if dimension == 2 {
        return [normal, [-normal[1], normal[0], 0.0], [0.0, 0.0, 1.0]];
    }
    let start = if normal[0].abs() < 0.9 {
        [1.0, 0.0, 0.0]
    } else {
        [0.0, 1.0, 0.0]
    };
    let along: f64 = (0..3).map(|k| start[k] * normal[k]).sum();
    let mut first: [f64; 3] = std::array::from_fn(|k| start[k] - along * normal[k]);
    let length = first.iter().map(|x| x * x).sum::<f64>().sqrt();
    first = first.map(|x| x / length);
    [normal, first, cross(normal, first)]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
