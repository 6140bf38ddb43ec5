//! A solved contact in 2D as a picture in SVG that stands alone: deformed meshes, obstacles, pressure.
//!
//! ```text
//! drawn position   x + k u          k = 1, 2, 5, 10, 20 …: the largest displacement stays below a
//!                                   twelfth of the bodies' extent
//! pressure         on each facet of the contact surface, along the contacts' normals
//! ```
//!
//! Obstacles and gaps before loading are drawn as they are, not enlarged.

use std::collections::HashMap;
use std::fmt::Write;

use super::digits::number;
use super::svg::{escaped, plain, text};
use super::{Report, ReportedContactState};
use crate::body::{Body, Facet};
use crate::contact::{Obstacle, RigidMotion};
use crate::error::{Error, check_length};

/// Largest width and height of what is drawn, and the margin around it.
const SIZE: [f64; 2] = [820.0, 520.0];
const MARGIN: f64 = 24.0;

/// Height of the title above and of the legend below.
const TITLE: f64 = 30.0;
const LEGEND: f64 = 40.0;

/// Largest displacement and pressure as drawn, of the diagonal of all bodies.
const ENLARGED: f64 = 1.0 / 12.0;
const PEAK: f64 = 1.0 / 6.0;

/// Bodies with more cells than this are drawn as outlines.
const MOST_CELLS: usize = 20_000;

/// States and their colours (Okabe, Ito 2008).
const STATES: [(ReportedContactState, &str, &str); 3] = [
    (ReportedContactState::Stick, "stick", "#0072b2"),
    (ReportedContactState::Slip, "slip", "#d55e00"),
    (ReportedContactState::Open, "open", "#ffffff"),
];

/// What a picture shows; all arrays per body are in the order of the report.
pub(crate) struct Picture<'a> {
    /// The solved state.
    pub(crate) report: &'a Report,
    /// The bodies, in 2D.
    pub(crate) bodies: &'a [Body],
    /// Displacement per body and unknown (`node · 2 + axis`), in metre.
    pub(crate) displacements: &'a [Vec<f64>],
    /// Facets of the contact surface, with the index of their body.
    pub(crate) facets: &'a [(usize, Facet)],
    /// The obstacles that they may touch, and how these have moved.
    pub(crate) obstacles: &'a [(Obstacle, RigidMotion)],
}

impl Picture<'_> {
    /// The picture in SVG.
    ///
    /// # Errors
    ///
    /// [`Error::NotAccepted`] for bodies in 3D, [`Error::Length`] if a displacement is not the mesh's.
    pub(crate) fn to_svg(&self) -> Result<String, Error> {
        self.check()?;
        let (extent, factor) = self.enlargement();
        let positions = self.deformed(factor);
        // What is glued may be pulled harder than anything is pressed.
        let pressures = self
            .report
            .contacts
            .iter()
            .filter_map(|contact| contact.pressure);
        let peak = pressures.fold(0.0, |most: f64, pressure| most.max(pressure.abs()));
        let height = |pressure: f64| match peak > 0.0 {
            true => PEAK * extent * pressure / peak,
            false => 0.0,
        };
        let marks = self.marks(&positions, height);
        let ends = marks.iter().map(|mark| mark.tip);
        let words = self.report.title.chars().count();
        let view = View::around(positions.iter().flatten().copied().chain(ends), words);
        let title = escaped(&self.report.title);
        let mut svg = view.open(&title);
        for (obstacle, motion) in self.obstacles {
            let moved = view.moved(motion, factor);
            let _ = writeln!(svg, "<g{moved}>");
            draw_obstacle(&mut svg, &view, obstacle);
            svg.push_str("</g>\n");
        }
        for (body, places) in self.bodies.iter().zip(&positions) {
            draw_body(&mut svg, &view, body, places);
        }
        self.draw_pressure(&mut svg, &view, &marks);
        self.draw_legend(&mut svg, &view, factor);
        let _ = writeln!(
            svg,
            "<rect width=\"100%\" height=\"{TITLE}\" fill=\"#fff\"/>\n<text x=\"{MARGIN}\" y=\"22\" \
             font-size=\"16\" font-weight=\"bold\">{title}</text>"
        );
        Ok(svg + "</svg>\n")
    }

    fn check(&self) -> Result<(), Error> {
        check_length("displacements", self.bodies.len(), self.displacements.len())?;
        for (at, (body, displacement)) in self.bodies.iter().zip(self.displacements).enumerate() {
            if body.mesh.dimension != 2 {
                return Err(Error::NotAccepted {
                    place: "picture".to_owned(),
                    found: "bodies in 3D".to_owned(),
                    accepted: "bodies in 2D; VTU files show those in 3D".to_owned(),
                });
            }
            let place = format!("displacements[{at}]");
            check_length(&place, 2 * body.mesh.nodes.len(), displacement.len())?;
        }
        Ok(())
    }

    /// Diagonal of the bodies before loading, and the factor on displacements.
    fn enlargement(&self) -> (f64, f64) {
        let nodes = self.bodies.iter().flat_map(|body| &body.mesh.nodes);
        let extent = Bounds::around(nodes.map(|node| [node[0], node[1]])).diagonal();
        let pairs = self.displacements.iter().flat_map(|u| u.chunks_exact(2));
        let largest = pairs.map(|u| u[0].hypot(u[1])).fold(0.0, f64::max);
        let most = ENLARGED * extent / largest;
        match most.is_finite() && most > 1.0 {
            true => (extent, round_below(most)),
            false => (extent, 1.0),
        }
    }

    /// Drawn position per body and node.
    fn deformed(&self, factor: f64) -> Vec<Vec<[f64; 2]>> {
        let solved = self.bodies.iter().zip(self.displacements);
        let places = solved.map(|(body, displacement)| {
            let nodes = body.mesh.nodes.iter().zip(displacement.chunks_exact(2));
            let moved = nodes.map(|(x, u)| [x[0] + factor * u[0], x[1] + factor * u[1]]);
            moved.collect()
        });
        places.collect()
    }

    /// Where the contacts are, and how high their pressure stands above them.
    fn marks(&self, positions: &[Vec<[f64; 2]>], height: impl Fn(f64) -> f64) -> Vec<Mark> {
        let contacts = self.report.contacts.iter();
        let marks = contacts.map(|contact| {
            let foot = positions[contact.body][contact.node];
            let length = height(contact.pressure.unwrap_or(0.0));
            Mark {
                node: (contact.body, contact.node),
                foot,
                tip: [0, 1].map(|axis| foot[axis] + length * contact.normal[axis]),
                state: contact.state,
            }
        });
        marks.collect()
    }

    fn draw_pressure(&self, svg: &mut String, view: &View, marks: &[Mark]) {
        let mark_at: HashMap<(usize, usize), &Mark> =
            marks.iter().map(|mark| (mark.node, mark)).collect();
        svg.push_str("<g fill=\"#cc79a7\" fill-opacity=\"0.45\" stroke=\"#882255\">\n");
        for (body, facet) in self.facets {
            let ends = facet.corners(2).iter();
            let ends: Vec<&Mark> = ends
                .filter_map(|&node| mark_at.get(&(*body, node)).copied())
                .collect();
            if let [a, b] = ends[..]
                && (a.foot != a.tip || b.foot != b.tip)
            {
                let _ = writeln!(
                    svg,
                    "<path d=\"{}\"/>",
                    view.closed([a.foot, a.tip, b.tip, b.foot])
                );
            }
        }
        svg.push_str("</g>\n<g stroke=\"#222\" stroke-width=\"0.7\">\n");
        for mark in marks {
            draw_mark(svg, view.place(mark.foot), mark.state);
        }
        svg.push_str("</g>\n");
    }

    fn draw_legend(&self, svg: &mut String, view: &View, factor: f64) {
        let [width, height] = view.size;
        let (y, mut x) = (height - 0.4 * LEGEND, MARGIN);
        let _ = writeln!(
            svg,
            "<rect y=\"{:.1}\" width=\"{width:.1}\" height=\"{LEGEND}\" fill=\"#fff\"/>\n\
             <g stroke=\"#222\" stroke-width=\"0.7\">",
            height - LEGEND
        );
        for (state, ..) in STATES {
            draw_mark(svg, [x, y - 4.5], state);
            x += 62.0;
        }
        svg.push_str("</g>\n");
        for ((_, word, _), column) in STATES.into_iter().zip(0..) {
            let x = MARGIN + 62.0 * f64::from(column);
            text(svg, [x + 9.0, y], "start", word);
        }
        let units = match self.report.units.is_empty() {
            true => String::new(),
            false => format!(" ({})", self.report.units),
        };
        let words = format!(
            "peak pressure {}{units}, displacements × {}",
            number(self.report.totals.peak_pressure),
            plain(factor)
        );
        text(svg, [width - MARGIN, y], "end", &words);
    }
}

/// A contact as drawn.
struct Mark {
    /// Body and node.
    node: (usize, usize),
    foot: [f64; 2],
    tip: [f64; 2],
    state: ReportedContactState,
}

/// The largest of 1, 2 and 5 times a power of ten that is not above a value.
fn round_below(value: f64) -> f64 {
    let power = 10.0_f64.powf(value.log10().floor());
    let steps = [5.0, 2.0].map(|step| step * power);
    let step = steps.into_iter().find(|step| *step <= value);
    step.unwrap_or(power)
}

/// A box around points.
#[derive(Clone, Copy)]
struct Bounds {
    low: [f64; 2],
    high: [f64; 2],
}

impl Bounds {
    fn around(points: impl Iterator<Item = [f64; 2]>) -> Self {
        let nothing = Self {
            low: [f64::INFINITY; 2],
            high: [f64::NEG_INFINITY; 2],
        };
        points.fold(nothing, |bounds, point| Self {
            low: [0, 1].map(|axis| bounds.low[axis].min(point[axis])),
            high: [0, 1].map(|axis| bounds.high[axis].max(point[axis])),
        })
    }

    fn extent(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.high[axis] - self.low[axis])
    }

    fn diagonal(&self) -> f64 {
        let [width, height] = self.extent();
        width.hypot(height)
    }
}

/// How positions become places of the drawing, whose second axis points down.
struct View {
    bounds: Bounds,
    scale: f64,
    size: [f64; 2],
}

impl View {
    /// Around points, and wide enough for the legend and a title of so many characters.
    fn around(points: impl Iterator<Item = [f64; 2]>, title: usize) -> Self {
        let bounds = Bounds::around(points);
        let extent = bounds.extent();
        let scale = (SIZE[0] / extent[0]).min(SIZE[1] / extent[1]);
        let drawn = extent.map(|length| scale * length + 2.0 * MARGIN);
        Self {
            bounds,
            scale,
            size: [
                drawn[0].max(640.0).max(2.0 * MARGIN + 10.2 * title as f64),
                drawn[1] + TITLE + LEGEND,
            ],
        }
    }

    /// The motion of an obstacle, enlarged, as an attribute; none of what stands still.
    fn moved(&self, motion: &RigidMotion, factor: f64) -> String {
        let ([u, v, _], [_, _, turn]) = (motion.translation, motion.rotation);
        if [u, v, turn] == [0.0; 3] {
            return String::new();
        }
        let [x, y] = self.place([motion.about[0], motion.about[1]]);
        let [right, down] = [u, -v].map(|along| factor * self.scale * along);
        let angle = -(factor * turn).to_degrees();
        format!(" transform=\"translate({right:.1} {down:.1}) rotate({angle:.3} {x:.1} {y:.1})\"")
    }

    fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let free = self.size[0] - self.scale * self.bounds.extent()[0];
        [
            0.5 * free + self.scale * (x - self.bounds.low[0]),
            TITLE + MARGIN + self.scale * (self.bounds.high[1] - y),
        ]
    }

    /// A closed path through positions.
    fn closed(&self, positions: impl IntoIterator<Item = [f64; 2]>) -> String {
        let mut path = String::new();
        for (at, position) in positions.into_iter().enumerate() {
            let [x, y] = self.place(position);
            let _ = write!(path, "{}{x:.1} {y:.1}", if at == 0 { 'M' } else { 'L' });
        }
        path + "Z"
    }

    fn open(&self, title: &str) -> String {
        let [width, height] = self.size;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" \
             role=\"img\" font-family=\"sans-serif\" font-size=\"13\" fill=\"#222\">\n\
             <title>{title}</title>\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
        )
    }
}

/// Half-space or disc; what lies outside the drawing is cut off by whoever shows it.
fn draw_obstacle(svg: &mut String, view: &View, obstacle: &Obstacle) {
    let paint = "fill=\"#ddd\" stroke=\"#777\"";
    let _ = match obstacle {
        Obstacle::Plane { point, normal } => {
            let middle = [0, 1].map(|axis| 0.5 * (view.bounds.low[axis] + view.bounds.high[axis]));
            let length = normal[0].hypot(normal[1]);
            let [n_x, n_y] = [normal[0] / length, normal[1] / length];
            let far = 2.0 * view.bounds.diagonal();
            let along = (point[0] - middle[0]) * n_x + (point[1] - middle[1]) * n_y;
            let foot = [middle[0] + along * n_x, middle[1] + along * n_y];
            let corner =
                |t: f64, d: f64| [foot[0] - t * n_y - d * n_x, foot[1] + t * n_x - d * n_y];
            let corners = [[-far, 0.0], [far, 0.0], [far, far], [-far, far]];
            let path = view.closed(corners.map(|[t, d]| corner(t, d)));
            writeln!(svg, "<path d=\"{path}\" {paint}/>")
        }
        Obstacle::Cylinder { center, radius, .. } | Obstacle::Sphere { center, radius } => {
            let [x, y] = view.place([center[0], center[1]]);
            let radius = view.scale * *radius;
            writeln!(
                svg,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius:.1}\" {paint}/>"
            )
        }
        other => draw_outline(svg, view, other),
    };
}

/// The line that bounds an obstacle.
fn draw_outline(svg: &mut String, view: &View, obstacle: &Obstacle) -> std::fmt::Result {
    let far = 2.0 * view.bounds.diagonal();
    let points = obstacle.section(far);
    let places = points.iter().map(|&point| view.place(point));
    let path: Vec<String> = places.map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    let path = path.join(" ");
    writeln!(
        svg,
        "<polyline points=\"{path}\" fill=\"none\" stroke=\"#777\" stroke-width=\"2\"/>"
    )
}

fn draw_body(svg: &mut String, view: &View, body: &Body, places: &[[f64; 2]]) {
    let mesh = &body.mesh;
    if mesh.cell_count() <= MOST_CELLS {
        svg.push_str("<path fill=\"#eef3f7\" stroke=\"#9ab\" stroke-width=\"0.6\" d=\"");
        for cell in mesh.cells() {
            let corners = cell.kind.corner_count();
            svg.push_str(&view.closed(around(cell.nodes, corners).map(|node| places[node])));
        }
        svg.push_str("\"/>\n");
    }
    svg.push_str("<path fill=\"none\" stroke=\"#345\" stroke-width=\"1.2\" d=\"");
    for facet in mesh.boundary_facets() {
        let [first, last, middle @ ..] = &facet.nodes[..] else {
            continue;
        };
        for (at, &node) in [first].into_iter().chain(middle).chain([last]).enumerate() {
            let [x, y] = view.place(places[node]);
            let _ = write!(svg, "{}{x:.1} {y:.1}", if at == 0 { 'M' } else { 'L' });
        }
    }
    svg.push_str("\"/>\n");
}

/// The nodes of a cell in the order of its boundary: each corner, then the node before the next one.
fn around(nodes: &[usize], corners: usize) -> impl Iterator<Item = usize> {
    let with_middle = nodes.len() >= 2 * corners;
    (0..corners).flat_map(move |corner| {
        let middle = with_middle.then(|| nodes[corners + corner]);
        std::iter::once(nodes[corner]).chain(middle)
    })
}

fn draw_mark(svg: &mut String, [x, y]: [f64; 2], state: ReportedContactState) {
    let colour = STATES.iter().find(|known| known.0 == state);
    let colour = colour.map_or("#fff", |known| known.2);
    let _ = writeln!(
        svg,
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>"
    );
}
