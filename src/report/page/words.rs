//! Totals and certificate of a state in words.

use serde::Serialize;

use crate::report::digits::{number, size};
use crate::report::{
    Report, ReportedDefect, ReportedFailure, ReportedShortfall, ReportedStatus, ReportedWorst,
};

/// A line of the table of totals.
#[derive(Debug, Serialize)]
pub(super) struct Row {
    name: String,
    value: String,
}

/// What must hold, and by how much it does not.
#[derive(Debug, Serialize)]
pub(super) struct Law {
    /// In words.
    law: String,
    /// Size of the worst violation in the units of the scene, and relative to the load.
    size: String,
    scaled: String,
    /// Where; empty where nothing is violated.
    place: String,
}

/// How the solve ended, and what to do where there is no certificate.
pub(super) fn status(report: &Report) -> Vec<String> {
    let first = match report.status {
        ReportedStatus::Certified => format!(
            "Certified: every law of contact and friction was measured on the original problem and \
             holds; what is left is {} of the reaction (natural map).",
            size(report.certificate.natural_map)
        ),
        ReportedStatus::NotConverged => {
            "Not converged: this is the best state found, it is not certified.".to_owned()
        }
        ReportedStatus::NoEquilibrium => {
            let why = ReportedFailure::heading(report.failure.as_ref());
            format!("No equilibrium: {why}.")
        }
        ReportedStatus::CouplingFault => {
            "Coupling fault: the bodies are not in the state that the contact problem says."
                .to_owned()
        }
    };
    let mut words = vec![first];
    if let Some(ReportedShortfall { reason, advice }) = &report.shortfall {
        words.push(format!("Reason: {}.", reason.words()));
        words.push(format!("Advice: {advice}."));
    }
    if let Some(failure) = &report.failure {
        words.push(format!("Motion: {}.", failure.words));
    }
    words
}

/// Totals over the contact surface, extremes, supports, and of a load history its energy.
pub(super) fn totals(report: &Report) -> Vec<Row> {
    let (totals, largest) = (&report.totals, &report.extremes);
    let mut rows = Vec::new();
    let mut add = |name: &str, value: String| {
        let name = name.to_owned();
        rows.push(Row { name, value });
    };
    let (open, stick, slip) = (totals.open, totals.stick, totals.slip);
    add("contacts", report.size.contacts.to_string());
    add("stick / slip / open", format!("{stick} / {slip} / {open}"));
    add("normal force", number(totals.normal));
    add("friction force", vector(&totals.friction));
    add("contact force", vector(&totals.contact_force));
    add("moment about the origin", vector(&totals.moment));
    add("contact area", number(totals.contact_area));
    add("slipping area", number(totals.slip_area));
    add("peak pressure", number(totals.peak_pressure));
    add("largest displacement", number(largest.displacement.value));
    add("largest von Mises stress", number(largest.von_mises.value));
    add("largest strain", number(largest.strain.value));
    add("largest rotation, degrees", number(largest.rotation.value));
    for support in &report.supports {
        add(
            &format!("support {}", support.place),
            vector(&support.force),
        );
    }
    for group in &report.rigid_groups {
        let place = &group.place;
        add(
            &format!("{place}: displacement"),
            vector(&group.displacement),
        );
        add(&format!("{place}: rotation"), vector(&group.rotation));
        add(&format!("{place}: force"), vector(&group.force));
        add(&format!("{place}: moment"), vector(&group.moment));
    }
    if totals.pairs.len() > 1 {
        for pair in &totals.pairs {
            let (place, totals) = (&pair.place, &pair.totals);
            let (stick, slip, open) = (totals.stick, totals.slip, totals.open);
            let states = format!("{stick} / {slip} / {open}");
            add(&format!("{place}: stick / slip / open"), states);
            add(&format!("{place}: normal force"), number(totals.normal));
            add(
                &format!("{place}: friction force"),
                vector(&totals.friction),
            );
            let peak = number(totals.peak_pressure);
            add(&format!("{place}: peak pressure"), peak);
        }
    }
    if let Some(step) = &report.step {
        let total = &step.total;
        let work = total.loads + total.supports + total.obstacles + total.fits;
        add("work since the start", number(work));
        add("elastic energy", number(total.elastic));
        add("dissipated by friction", number(total.dissipation));
        add("energy unexplained", size(total.closure));
    }
    let extent = &report.size;
    add("nodes", extent.nodes.to_string());
    add("cells", extent.cells.to_string());
    add("seconds", format!("{:.3}", report.work.seconds.total));
    rows
}

/// Every law with its worst violation.
pub(super) fn laws(report: &Report) -> Vec<Law> {
    let found = &report.certificate;
    let contact = |law: &str, worst: &ReportedWorst| {
        let place = format!("contact {}", worst.contact);
        law_of(law, worst.value, worst.scaled, place)
    };
    let mut laws = vec![
        contact("Bodies do not penetrate", &found.penetration),
        contact("Contact pushes and never pulls", &found.tension),
        contact(
            "Where there is a gap there is no pressure",
            &found.complementarity,
        ),
        contact(
            "Friction stays below μ times the pressure",
            &found.disc_excess,
        ),
        contact(
            "Friction opposes slip, and is full where it slips",
            &found.dissipation_defect,
        ),
        contact("The bodies move as the contacts say", &found.recovered),
    ];
    if let Some(ReportedDefect { value, scaled }) = found.equilibrium {
        let law = "Contact answers every load on bodies that only contact holds";
        laws.push(law_of(law, value, scaled, String::new()));
    }
    for body in &found.bodies {
        let (name, nodal, given) = (&body.name, body.equilibrium, body.support);
        let place = |node: usize| format!("node {node}");
        let law = format!("{name}: forces balance at every node");
        laws.push(law_of(&law, nodal.value, nodal.scaled, place(nodal.node)));
        let law = format!("{name}: supports move as given");
        laws.push(law_of(&law, given.value, given.scaled, place(given.node)));
        for (what, defect) in [
            ("forces", body.force_defect),
            ("moments", body.moment_defect),
        ] {
            let law = format!("{name}: all {what} add up to zero");
            laws.push(law_of(&law, defect.value, defect.scaled, String::new()));
        }
    }
    for pair in &report.totals.pairs {
        let Some(exchange) = &pair.exchange else {
            continue;
        };
        let (defect, place) = (exchange.force_defect, pair.place.clone());
        let law = "Both sides of a pair receive the same force";
        laws.push(law_of(law, defect.value, defect.scaled, place));
    }
    laws
}

fn law_of(law: &str, value: f64, scaled: f64, place: String) -> Law {
    Law {
        law: law.to_owned(),
        size: size(value),
        scaled: size(scaled),
        place: if value == 0.0 { String::new() } else { place },
    }
}

fn vector(components: &[f64]) -> String {
    let components: Vec<String> = components.iter().map(|&c| number(c)).collect();
    match components.as_slice() {
        [single] => single.clone(),
        several => format!("({})", several.join(", ")),
    }
}
