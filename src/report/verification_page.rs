//! The verification manual: the gallery as one page of HTML that needs nothing else.

use std::fmt::Write;

use super::figure::{Axis, Curve, Figure, Point};
use super::study_page::{STYLE, table};
use super::svg::escaped;
use super::verification::{Verification, VerifiedQuantity, VerifiedScene, number, size};

/// An error of nothing is drawn as round-off, for there is no zero on a logarithmic axis.
const EXACT: f64 = f64::EPSILON;

impl Verification {
    /// The page: contents, then of each scene its picture, source, floor, errors against the size of cells, and a
    /// table of every mesh. `command` is what made it.
    #[must_use]
    pub fn page(&self, command: &str) -> String {
        let passed = self.scenes.iter().filter(|scene| scene.passed).count();
        let mut page = format!(
            "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
             <meta name=\"viewport\" content=\"width=device-width\">\n<title>Verification manual</title>\n\
             <style>{STYLE}</style>\n</head>\n<body>\n<h1>Verification manual</h1>\n\
             <p>Made by <code>{}</code>, version {}: {passed} of {} scenes pass. Every scene is solved on a ladder \
             of meshes; an error is |computed/exact − 1|, or a relative norm where a quantity is a field, and the \
             rate its exponent in the size of the cells. Equations (E1), (E2), … stand in \
             <code>dpana::closed_forms</code>.</p>\n<ol>\n",
            escaped(command),
            env!("CARGO_PKG_VERSION"),
            self.scenes.len(),
        );
        for (at, scene) in self.scenes.iter().enumerate() {
            let verdict = if scene.passed { "passes" } else { "FAILS" };
            let name = escaped(scene.name);
            let _ = writeln!(
                page,
                "<li><a href=\"#scene{at}\">{name}</a>: {verdict}</li>"
            );
        }
        page += "</ol>\n";
        for (at, scene) in self.scenes.iter().enumerate() {
            scene.section(&mut page, at);
        }
        page + "</body>\n</html>\n"
    }
}

impl VerifiedScene {
    fn section(&self, page: &mut String, at: usize) {
        let (name, source) = (escaped(self.name), escaped(self.source));
        let _ = writeln!(
            page,
            "<section id=\"scene{at}\">\n<h2>{}. {name}</h2>\n<p>Known from: {source}. Solved in {:.1} s.</p>",
            at + 1,
            self.seconds
        );
        if let Some(picture) = &self.picture {
            let _ = writeln!(
                page,
                "<figure>\n{picture}<figcaption>On a coarse mesh.</figcaption>\n</figure>"
            );
        }
        let figure = self.errors();
        if !figure.curves.is_empty() {
            let _ = writeln!(
                page,
                "<figure>\n{}<figcaption>Every point is a mesh.</figcaption>\n</figure>",
                figure.to_svg()
            );
        }
        if !self.floor.is_empty() {
            let _ = writeln!(
                page,
                "<p>What keeps the error up: {}.</p>",
                escaped(self.floor)
            );
        }
        let heads = [
            "quantity",
            "mesh",
            "here",
            "exact",
            "error",
            "rate",
            "criterion",
        ];
        let rows = self.quantities.iter().flat_map(VerifiedQuantity::rows);
        table(page, "", &heads.map(str::to_owned), rows);
        *page += "</section>\n";
    }

    /// Errors against the size of cells, of quantities on several sizes.
    fn errors(&self) -> Figure {
        let curve = |quantity: &VerifiedQuantity| {
            let points = quantity.ladder.iter().map(|rung| Point {
                at: [rung.size, rung.error.max(EXACT)],
                open: !rung.settled,
            });
            let points: Vec<Point> = points.collect();
            let several = points.windows(2).any(|pair| pair[0].at[0] != pair[1].at[0]);
            several.then(|| Curve {
                name: quantity.quantity.to_owned(),
                points,
            })
        };
        let axis = |label: &str| Axis {
            label: label.to_owned(),
            logarithmic: true,
        };
        Figure {
            title: self.name.to_owned(),
            across: axis("size of cells, relative"),
            up: axis("relative error"),
            curves: self.quantities.iter().filter_map(curve).collect(),
            open: "not settled",
        }
    }
}

impl VerifiedQuantity {
    /// A row per mesh; rate and criterion beside the finest.
    fn rows(&self) -> impl Iterator<Item = (bool, Vec<String>)> {
        let last = self.ladder.len().saturating_sub(1);
        self.ladder.iter().enumerate().map(move |(at, rung)| {
            let value = |value: Option<f64>| value.map_or_else(String::new, number);
            let finest = |text: String| if at == last { text } else { String::new() };
            let rate = self
                .rate
                .map_or_else(String::new, |rate| format!("{rate:.2}"));
            let row = vec![
                self.quantity.to_owned(),
                rung.mesh.clone(),
                value(rung.computed),
                value(rung.exact),
                size(rung.error),
                finest(rate),
                finest(self.verdict()),
            ];
            (!self.passed, row)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Criterion, Rung};

    fn manual(passed: bool) -> String {
        let rung = |size: f64| Rung {
            mesh: format!("{size} < 1"),
            size,
            settled: true,
            computed: Some(1.0 + size),
            exact: Some(1.0),
            error: size,
        };
        let quantity = VerifiedQuantity {
            quantity: "load, N",
            criterion: Criterion::FinestMesh { within: 0.01 },
            ladder: vec![rung(0.5), rung(0.25)],
            rate: Some(1.0),
            passed,
        };
        let scene = VerifiedScene {
            name: "a block & a plane",
            source: "statics",
            floor: "round-off",
            picture: Some("<svg class=\"drawn\"></svg>".to_owned()),
            passed,
            seconds: 1.0,
            quantities: vec![quantity],
        };
        let all = Verification {
            quick: true,
            passed,
            scenes: vec![scene],
        };
        all.page("dpana verify --page a.html")
    }

    #[test]
    fn a_scene_has_its_picture_source_floor_figure_and_a_row_per_mesh() {
        let page = manual(true);
        for part in [
            "a block &amp; a plane",
            "Known from: statics",
            "class=\"drawn\"",
            "What keeps the error up: round-off",
            "0.5 &lt; 1",
            "0.25 &lt; 1",
            "last &lt;= 1.0e-2: pass",
            "<td>1.00</td>",
        ] {
            assert!(page.contains(part), "{part}: {page}");
        }
        assert_eq!(page.matches("<svg").count(), 2);
        assert!(!page.contains("class=\"bad\""));
    }

    #[test]
    fn what_fails_is_said_in_contents_and_table() {
        let page = manual(false);
        assert!(page.contains("FAILS") && page.contains(": FAIL"));
        assert_eq!(page.matches("class=\"bad\"").count(), 2);
    }
}
