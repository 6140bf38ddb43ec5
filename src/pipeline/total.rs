//! A number that stands for a state: a total, the energy, or the displacement of a point.

use super::Solution;
use crate::error::Error;
use crate::report::Table;
use crate::scene::nearest;

/// What is asked of a state.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Total {
    /// A column of the table of totals.
    Column(String),
    /// Elastic energy of all bodies.
    Energy,
    /// Displacement along an axis of the node nearest to a point, of all bodies or one.
    Displacement {
        axis: usize,
        body: Option<String>,
        at: [f64; 3],
    },
}

const ACCEPTED: &str = "`energy`, a column of `dpana solve --table` such as normal, friction_x or peak_pressure, \
                        or a displacement at a point such as u_x@0.5,0 or u_y@pad:0.5,0";

impl Total {
    pub(super) fn parse(text: &str) -> Result<Self, Error> {
        let refuse = || Error::NotAccepted {
            place: "total".to_owned(),
            found: format!("`{text}`"),
            accepted: ACCEPTED.to_owned(),
        };
        let Some((name, place)) = text.split_once('@') else {
            return Ok(match text {
                "energy" => Self::Energy,
                column => Self::Column(column.to_owned()),
            });
        };
        let names = ["u_x", "u_y", "u_z"];
        let axis = names
            .iter()
            .position(|known| *known == name)
            .ok_or_else(refuse)?;
        let (body, point) = match place.rsplit_once(':') {
            Some((body, point)) => (Some(body.to_owned()), point),
            None => (None, place),
        };
        let numbers = point.split(',').map(|number| number.trim().parse().ok());
        let numbers: Vec<f64> = numbers.collect::<Option<_>>().ok_or_else(refuse)?;
        if !(2..=3).contains(&numbers.len()) || !numbers.iter().all(|x| x.is_finite()) {
            return Err(refuse());
        }
        let mut at = [0.0; 3];
        at[..numbers.len()].copy_from_slice(&numbers);
        Ok(Self::Displacement { axis, body, at })
    }

    pub(super) fn value(&self, solution: &Solution) -> Result<f64, Error> {
        match self {
            Self::Column(name) => column(solution, name),
            Self::Energy => Ok(solution.elastic_energy()),
            Self::Displacement { axis, .. } => {
                let (body, node) = self.node(solution)?;
                let axes = solution.bodies()[body].mesh.dimension;
                Ok(solution.displacements()[body][node * axes + axis])
            }
        }
    }

    /// What it jumps by as one contact opens or slips: the largest area of one, or one; zero where it does not jump.
    pub(super) fn grain(&self, solution: &Solution) -> f64 {
        let contacts = solution.condensed().surface().nodes.iter();
        match self {
            Self::Column(name) if name.ends_with("_area") => {
                contacts.fold(0.0, |most, contact| contact.area.max(most))
            }
            Self::Column(name) if ["open", "stick", "slip"].contains(&name.as_str()) => 1.0,
            _ => 0.0,
        }
    }

    /// Its derivative with respect to a parameter; none where it has none.
    pub(super) fn rate(&self, solution: &Solution, parameter: &str) -> Result<Option<f64>, Error> {
        match self {
            Self::Energy => Ok(None),
            Self::Column(name) => {
                let found = solution.sensitivity(parameter)?;
                Ok(found.and_then(|found| found.of(name)))
            }
            Self::Displacement { axis, .. } => {
                let (body, node) = self.node(solution)?;
                let axes = solution.bodies()[body].mesh.dimension;
                let rates = solution.displacement_rates(parameter)?;
                Ok(rates.map(|rates| rates.growing[body][node * axes + axis]))
            }
        }
    }

    /// The same of other meshes: a displacement stays that of the place where this one has its node.
    pub(super) fn kept(self, solution: &Solution) -> Result<Self, Error> {
        let (found, node) = self.node(solution)?;
        Ok(match self {
            Self::Displacement { axis, body, .. } => Self::Displacement {
                axis,
                body,
                at: solution.bodies()[found].mesh.nodes[node],
            },
            other => other,
        })
    }

    /// Body and node of a displacement.
    fn node(&self, solution: &Solution) -> Result<(usize, usize), Error> {
        let Self::Displacement { axis, body, at } = self else {
            return Ok((0, 0));
        };
        let bodies = solution.bodies();
        let names = bodies.iter().map(|body| body.name.as_str());
        if let Some(name) = body
            .as_ref()
            .filter(|name| !names.clone().any(|n| n == name.as_str()))
        {
            return Err(unknown("body", name, names.map(str::to_owned).collect()));
        }
        let asked = |name: &str| body.as_ref().is_none_or(|body| body == name);
        let chosen = bodies.iter().enumerate().filter(|(_, of)| asked(&of.name));
        let nodes = chosen.flat_map(|(index, of)| {
            let nodes = of.mesh.nodes.iter().enumerate();
            nodes.map(move |(node, position)| {
                let apart = (0..3).map(|k| (position[k] - at[k]).powi(2)).sum::<f64>();
                (apart, index, node)
            })
        });
        let nearest = nodes.min_by(|(a, ..), (b, ..)| a.total_cmp(b));
        let (_, body, node) = nearest.unwrap_or_default();
        let dimension = bodies[body].mesh.dimension;
        if *axis >= dimension {
            return Err(Error::NotAccepted {
                place: "total".to_owned(),
                found: "u_z".to_owned(),
                accepted: "u_x or u_y, as the bodies are plane".to_owned(),
            });
        }
        Ok((body, node))
    }
}

fn column(solution: &Solution, name: &str) -> Result<f64, Error> {
    let mut table = Table::default();
    table.push(&[], &solution.report()?);
    let found = table
        .column(name)
        .and_then(|column| column.first().copied());
    match found.filter(|value| !value.is_nan()) {
        Some(value) => Ok(value),
        None => Err(unknown("total", name, table.columns)),
    }
}

fn unknown(what: &'static str, name: &str, known: Vec<String>) -> Error {
    Error::UnknownName {
        place: "total".to_owned(),
        what,
        name: name.to_owned(),
        nearest: nearest(name, known.iter().map(String::as_str)).map(str::to_owned),
        known,
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn a_displacement_names_its_axis_its_point_and_maybe_its_body() {
        let found = Total::parse("u_y@left pad:0.5,-1e-2").unwrap();
        let expected = Total::Displacement {
            axis: 1,
            body: Some("left pad".to_owned()),
            at: [0.5, -0.01, 0.0],
        };
        assert_eq!(found, expected);
        assert_eq!(
            Total::parse("normal").unwrap(),
            Total::Column("normal".to_owned())
        );
        for wrong in ["u_w@0,0", "u_x@0", "u_x@0,nan", "u_x@0,0,0,0", "u_x@a,b"] {
            assert!(Total::parse(wrong).is_err(), "{wrong}");
        }
    }
}
