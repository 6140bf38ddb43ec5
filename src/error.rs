//! What can be wrong with an input, and how it is said.
//!
//! An error names the place, the value and what is accepted. Outcomes of a solve
//! that did run (not converged, no equilibrium) are a
//! [`Status`](crate::Status), never an error.

/// Why an input cannot be solved.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A number lies outside its accepted range.
    #[error("{place}: {value} is not accepted; expected {accepted}")]
    OutOfRange {
        /// Where the number stands, such as `bodies[0].materials[1].poisson`.
        place: String,
        /// The offending number.
        value: f64,
        /// The accepted range in words, such as `-1 < poisson < 0.5`.
        accepted: &'static str,
    },

    /// A value that a total takes nowhere in a range.
    #[error(
        "{place}: no value between {from} and {to} gives {target}; the totals seen there run from {lowest} to \
         {highest}"
    )]
    OutOfReach {
        /// Parameter and total, such as `friction, normal`.
        place: String,
        /// Where the range begins.
        from: f64,
        /// Where it ends.
        to: f64,
        /// The value that was asked for.
        target: f64,
        /// Least total that was seen.
        lowest: f64,
        /// Largest total that was seen.
        highest: f64,
    },

    /// A total that jumps over the value it should take.
    #[error(
        "{place}: at {at} the total jumps from {below} to {above} and never is {target}; expected a total \
         that changes without jumps, which areas and counts do not"
    )]
    Jumps {
        /// Parameter and total, such as `friction, contact_area`.
        place: String,
        /// Where it jumps.
        at: f64,
        /// On one side.
        below: f64,
        /// On the other.
        above: f64,
        /// The value that was asked for.
        target: f64,
    },

    /// A NaN or an infinity.
    #[error("{place}: {value} is not a finite number")]
    NotFinite {
        /// Where the number stands.
        place: String,
        /// NaN or an infinity.
        value: f64,
    },

    /// Two arrays that belong together differ in length.
    #[error("{place}: expected {expected} entries, found {found}")]
    Length {
        /// Name of the array.
        place: String,
        /// Length it must have.
        expected: usize,
        /// Length it has.
        found: usize,
    },

    /// A vector that cannot serve as the direction it is meant for.
    #[error("{place}: {value:?} is not accepted; expected {accepted}")]
    Direction {
        /// Where the vector stands, such as `contacts[0].obstacle.normal`.
        place: String,
        /// The offending vector.
        value: [f64; 3],
        /// What is accepted, in words.
        accepted: &'static str,
    },

    /// A shape in front of a body of another dimension, such as a sphere of a 2D body.
    #[error(
        "{place}: a shape of another dimension than its body's; expected one that lives there, as planes do"
    )]
    ObstacleDimension {
        /// The obstacle, such as `contacts[0].obstacle`.
        place: String,
    },

    /// A point that is equally far from all of a round obstacle.
    #[error(
        "{place}: the point {position:?} lies on the obstacle's axis or centre, \
         so no point of the obstacle is closest to it"
    )]
    NoClosestPoint {
        /// The contact pair, such as `contacts[0]`.
        place: String,
        /// The point of the body, in metre.
        position: [f64; 3],
    },

    /// No facet of a contact pair looks at its obstacle.
    #[error(
        "{place}: none of the {facets} facets faces the obstacle: their outward normals point away from it, \
         or it ends beside them; expected at least one facet in front of it whose outward normal points towards it"
    )]
    NothingFacesObstacle {
        /// The contact pair, such as `contacts[0]`.
        place: String,
        /// Number of facets of the pair.
        facets: usize,
    },

    /// No part of a contact pair's side faces the other side.
    #[error(
        "{place}: none of the {facets} facets faces any of the {opposite} facets of the other side \
         ({averted} pairs lie over each other but look the same way); expected outward normals that \
         point towards each other, within 60 degrees, and facets that cover each other along them"
    )]
    NothingFacesOpposite {
        /// The contact pair, such as `contacts[0]`.
        place: String,
        /// Number of facets of the side that carries the contacts.
        facets: usize,
        /// Number of facets of the other side.
        opposite: usize,
        /// Pairs of facets, one about over the other, with normals that do not oppose.
        averted: usize,
    },

    /// The two sides of a contact pair are in each other deeper than an interference fit.
    #[error(
        "{place}: the bodies overlap by {overlap:e} at {position:?}; expected at most {allowed:e}, \
         a twentieth of the extent of the smaller side"
    )]
    Overlap {
        /// The contact pair, such as `contacts[0]`.
        place: String,
        /// A point of the side that carries the contacts, in metre.
        position: [f64; 3],
        /// Depth of the overlap there, in metre.
        overlap: f64,
        /// Largest overlap accepted, in metre.
        allowed: f64,
    },

    /// No contact node is left.
    #[error(
        "the contact surface is empty: {pairs} contact pairs, {left_out} nodes left out because \
         a support holds their normal; expected at least one node that can move along its normal"
    )]
    EmptyContactSurface {
        /// Number of contact pairs.
        pairs: usize,
        /// Number of nodes left out.
        left_out: usize,
    },

    /// A support of a contact node is neither along nor across its normal.
    #[error(
        "{place}: node {node} at {position:?} has its normal along {normal:?} and is supported \
         along {axes}; expected supports that hold the normal or leave it free entirely"
    )]
    SupportAskew {
        /// The contact pair, such as `contacts[0]`.
        place: String,
        /// The node.
        node: usize,
        /// Its position, in metre.
        position: [f64; 3],
        /// Its contact normal.
        normal: [f64; 3],
        /// The supported axes, such as `x and y`.
        axes: String,
    },

    /// A contact node with friction is moved along the obstacle by a support.
    #[error(
        "{place}: node {node} at {position:?} has friction {friction} and a support moves it \
         by {displacement} along {axis}; expected 0 there, no friction, or `dragged`: true of the contact if it is meant to slip"
    )]
    DraggedContact {
        /// The contact pair, such as `contacts[0]`.
        place: String,
        /// The node.
        node: usize,
        /// Its position, in metre.
        position: [f64; 3],
        /// Coefficient of friction of the pair.
        friction: f64,
        /// Prescribed displacement, in metre.
        displacement: f64,
        /// The axis, `x`, `y` or `z`.
        axis: char,
    },

    /// The stiffness of the supported body is not positive definite.
    #[error(
        "{body}: the stiffness is not positive definite at node {node} at {position:?} \
         (pivot {pivot:e} of {diagonal:e}); expected supports that hold every motion, \
         cells without hinges, and a positive definite material"
    )]
    NotPositiveDefinite {
        /// Name of the body.
        body: String,
        /// Node at which the elimination broke down.
        node: usize,
        /// Its position, in metre.
        position: [f64; 3],
        /// The pivot, in N/m; NaN where the elimination stopped before computing it.
        pivot: f64,
        /// The diagonal entry it is left of, in N/m.
        diagonal: f64,
    },

    /// A stage ran out of memory or of index range.
    #[error("{body}: {stage} of {unknowns} unknowns needs more memory than there is")]
    TooLarge {
        /// Name of the body.
        body: String,
        /// The stage, such as `ordering`.
        stage: &'static str,
        /// Number of unknowns.
        unknowns: usize,
    },

    /// The dense matrices of a contact problem find no room.
    #[error(
        "contacts: {contacts} contacts have {unknowns} unknowns, whose dense compliance takes {gigabytes:.1} \
         GB: more memory than there is; expected fewer contacts, by smaller groups of facets or a coarser \
         surface"
    )]
    NoRoom {
        /// Number of contacts.
        contacts: usize,
        /// Number of their unknowns.
        unknowns: usize,
        /// What the matrices take.
        gigabytes: f64,
    },

    /// The operator of a bare problem is not symmetric.
    #[error(
        "operator: not symmetric by {:.1e} of its largest entry, worst where operator[{row}][{column}] differs \
         from operator[{column}][{row}] by {violation:e} (largest entry {largest:e}); expected at most 1e-10: if \
         the difference is rounding, solve the symmetric part (`BareProblem::symmetrised`)",
        violation / largest
    )]
    NotSymmetric {
        /// Row of the worst pair.
        row: usize,
        /// Its column.
        column: usize,
        /// Difference of the two entries, in m/N.
        violation: f64,
        /// Largest entry of the operator, in m/N.
        largest: f64,
    },

    /// The operator of a bare problem is not positive semi-definite.
    #[error(
        "operator: smallest eigenvalue {eigenvalue:e} (largest entry {largest:e}); expected a positive \
         semi-definite matrix, no eigenvalue below -1e-7 of the trace"
    )]
    Indefinite {
        /// Its smallest eigenvalue, in m/N.
        eigenvalue: f64,
        /// Its largest entry, in m/N.
        largest: f64,
    },

    /// A number that should point at a body, or at something of it, does not.
    #[error("{place}: {what} {index} does not exist; expected less than {count}")]
    UnknownIndex {
        /// Where the number stands.
        place: String,
        /// What it should point at: `body`, `pair`, `node`, `cell`, `material`.
        what: &'static str,
        /// The number.
        index: usize,
        /// How many there are.
        count: usize,
    },

    /// A plane thing in a solid, or the other way round.
    #[error("{place}: dimension {found} does not fit; expected {expected}")]
    WrongDimension {
        /// What does not fit.
        place: String,
        /// Dimension it must have.
        expected: usize,
        /// Dimension it has.
        found: usize,
    },

    /// Something that must be named once is named again.
    #[error("{place}: {what} {index:?} is listed twice")]
    Repeated {
        /// Where the list stands.
        place: String,
        /// What it lists: `cell`, `facet`.
        what: &'static str,
        /// Cell number, or node numbers of the facet.
        index: Vec<usize>,
    },

    /// A support or load on nothing, or a mesh without cells.
    #[error("{place}: empty; expected at least one entry")]
    Empty {
        /// Where the list stands.
        place: String,
    },

    /// A cell that is inside out, folded or without volume.
    #[error(
        "{place} at ({:.6e}, {:.6e}, {:.6e}) is inside out, folded or flat: signed volume \
         {volume:e}, smallest Jacobian {jacobian:e} of a well-shaped cell's 1; expected both positive (are its nodes in Gmsh's order?)",
        centroid[0], centroid[1], centroid[2]
    )]
    BadCell {
        /// Which cell, such as `block: cell 17`.
        place: String,
        /// Mean position of its nodes, in metre.
        centroid: [f64; 3],
        /// Signed volume, in m³ (2D: area in m²).
        volume: f64,
        /// Dimension of the body.
        dimension: usize,
        /// Least determinant of the normalised tangents over the cell, between −1 and 1.
        jacobian: f64,
    },

    /// A node that no cell uses.
    #[error(
        "{place} at ({:.6e}, {:.6e}, {:.6e}) belongs to no cell; expected at least one",
        position[0], position[1], position[2]
    )]
    LoneNode {
        /// Which node, such as `block: node 17`.
        place: String,
        /// Its position, in metre.
        position: [f64; 3],
    },

    /// A facet that is not on the surface.
    #[error(
        "{place}: the facet with nodes {nodes:?} belongs to {cells} cells; expected a facet of the surface, \
         which belongs to exactly one{}",
        parted(*cells)
    )]
    FacetOwners {
        /// Where the facet stands.
        place: String,
        /// Its nodes.
        nodes: Vec<usize>,
        /// How many cells it belongs to.
        cells: usize,
    },

    /// A surface facet whose nodes run backwards or crosswise, so that its normal would be wrong.
    #[error("{place}: the nodes {nodes:?} do not run around the facet in outward order")]
    FacetInward {
        /// Where the facet stands.
        place: String,
        /// Its nodes.
        nodes: Vec<usize>,
    },

    /// Two supports prescribe different displacements for one component.
    #[error(
        "{} prescribes {:e} and {} prescribes {:e} for component {component} of node {node}; \
         expected one value",
        places[0], values[0], places[1], values[1]
    )]
    ContradictorySupports {
        /// The two supports.
        places: [String; 2],
        /// The node.
        node: usize,
        /// `x`, `y` or `z`.
        component: char,
        /// What each prescribes, in metre.
        values: [f64; 2],
    },

    /// A file could not be written.
    #[error("{path}: cannot be written: {reason}")]
    Write {
        /// The file.
        path: String,
        /// What the system says.
        reason: String,
    },

    /// Something other than a number is not accepted where it stands.
    #[error("{place}: {found} is not accepted; expected {accepted}")]
    NotAccepted {
        /// Where it stands, such as `contacts[0].obstacle`.
        place: String,
        /// What stands there.
        found: String,
        /// What is accepted, in words.
        accepted: String,
    },

    /// A name that nothing carries.
    #[error(
        "{place}: there is no {what} `{name}`{}; expected {}",
        did_you_mean(nearest),
        listed(known)
    )]
    UnknownName {
        /// Where the name stands, such as `contacts[0].group`.
        place: String,
        /// What the name should stand for, such as `group`.
        what: &'static str,
        /// The name.
        name: String,
        /// The known name that is spelt most alike.
        nearest: Option<String>,
        /// All known names.
        known: Vec<String>,
    },

    /// No single node stands at a given position.
    #[error(
        "{place}: no node at {position:?}; the nearest is node {node} at {found:?}, {distance:e} \
         away; expected at most {tolerance:e}"
    )]
    NoNodeAt {
        /// Where the position stands, such as `bodies[0].supports[1].at`.
        place: String,
        /// The position, in metre.
        position: [f64; 3],
        /// The nearest node.
        node: usize,
        /// Its position, in metre.
        found: [f64; 3],
        /// Its distance, in metre.
        distance: f64,
        /// Largest distance accepted, in metre.
        tolerance: f64,
    },

    /// A scene's text is not JSON, or not a scene.
    #[error("{file}:{line}:{column}: {place}: {reason}")]
    Json {
        /// File name.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// Path inside the file, such as `bodies[0].materials[1].poisson`.
        place: String,
        /// What is wrong and what is accepted.
        reason: String,
    },

    /// A mesh file cannot be read as a mesh, or a deck as a scene.
    #[error("{file}:{line}: {reason}")]
    Mesh {
        /// File name.
        file: String,
        /// Line, from 1.
        line: usize,
        /// What is wrong and what is accepted.
        reason: String,
    },

    /// A file cannot be read.
    #[error("{place}: cannot read the file {file}: {reason}")]
    Unreadable {
        /// What the file should hold, such as `scene` or `bodies[0].mesh.file`.
        place: String,
        /// File name.
        file: String,
        /// The system's reason.
        reason: String,
    },

    /// Any other variant, with the larger place that it happened in.
    #[error("{place}: {error}")]
    Within {
        /// Such as the scene's file, or the group of a load.
        place: String,
        /// What is wrong there.
        error: Box<Error>,
    },
}

impl Error {
    /// Puts a larger place in front.
    pub(crate) fn within(self, place: impl std::fmt::Display) -> Self {
        Self::Within {
            place: place.to_string(),
            error: Box::new(self),
        }
    }
}

fn did_you_mean(nearest: &Option<String>) -> String {
    nearest
        .as_ref()
        .map(|name| format!(" (did you mean `{name}`?)"))
        .unwrap_or_default()
}

/// How bodies come apart that hold a facet together.
fn parted(cells: usize) -> &'static str {
    match cells {
        0 | 1 => "",
        _ => {
            " (where bodies touch, each needs nodes of its own: mesh them without joining their faces, in Gmsh \
             without `Coherence` and fragments, or from a file each)"
        }
    }
}

fn listed(known: &[String]) -> String {
    if known.is_empty() {
        return "none, as there are none".to_owned();
    }
    format!("one of `{}`", known.join("`, `"))
}

/// Refuses NaN and infinities, naming the first entry that holds one.
pub(crate) fn check_finite(place: &str, values: &[f64]) -> Result<(), Error> {
    match values.iter().position(|x| !x.is_finite()) {
        None => Ok(()),
        Some(at) => Err(Error::NotFinite {
            place: format!("{place}[{at}]"),
            value: values[at],
        }),
    }
}

/// Refuses an array of the wrong length.
pub(crate) fn check_length(place: &str, expected: usize, found: usize) -> Result<(), Error> {
    if expected == found {
        return Ok(());
    }
    Err(Error::Length {
        place: place.to_owned(),
        expected,
        found,
    })
}
