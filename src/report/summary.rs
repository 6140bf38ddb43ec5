//! The report on one screen.

use std::fmt::Write;

use super::digits::{number, size};
use super::{
    Largest, Report, ReportedBalance, ReportedDefect, ReportedDerivative, ReportedFailure,
    ReportedShortfall, ReportedStatus, ReportedWork,
};

/// How many contact pairs the summary lists before it only counts them.
const LISTED: usize = 8;

/// Twenty to forty aligned lines: status, contacts, totals, pairs if there are several,
/// worst violations, work, notes.
pub(super) fn summary(report: &Report) -> String {
    let mut text = String::new();
    // Writing into a string cannot fail.
    let _ = heading(&mut text, report)
        .and_then(|()| match &report.failure {
            Some(failure) => missing(&mut text, failure),
            None => totals(&mut text, report)
                .and_then(|()| extremes(&mut text, report))
                .and_then(|()| energy(&mut text, report))
                .and_then(|()| quality(&mut text, report))
                .and_then(|()| pairs(&mut text, report))
                .and_then(|()| asked(&mut text, report))
                .and_then(|()| violations(&mut text, report))
                .and_then(|()| trust(&mut text, report)),
        })
        .and_then(|()| work(&mut text, report));
    for note in &report.notes {
        let _ = writeln!(text, "note            {note}");
    }
    text
}

fn heading(text: &mut String, report: &Report) -> std::fmt::Result {
    let status = match report.status {
        ReportedStatus::Certified => "certified",
        ReportedStatus::NotConverged => "NOT CONVERGED: the best state found, it is not certified",
        ReportedStatus::NoEquilibrium => {
            let why = ReportedFailure::heading(report.failure.as_ref());
            &format!("NO EQUILIBRIUM: {why}")
        }
        ReportedStatus::CouplingFault => {
            "COUPLING FAULT: the bodies are not in the state reported below"
        }
    };
    let extent = &report.size;
    if !report.title.is_empty() {
        writeln!(text, "{}", report.title)?;
    }
    if let Some(step) = &report.step {
        writeln!(
            text,
            "step            {} at {}",
            step.number,
            number(step.at)
        )?;
    }
    writeln!(text, "status          {status}")?;
    if let Some(ReportedShortfall { reason, advice }) = &report.shortfall {
        writeln!(text, "reason          {}", reason.words())?;
        writeln!(text, "advice          {advice}")?;
    }
    if report.failure.is_none() {
        let residual = size(report.certificate.natural_map);
        writeln!(
            text,
            "residual        {residual} (natural map, relative to the reaction)"
        )?;
    }
    let units = match report.units.as_str() {
        "" => "not named; those of the scene",
        named => named,
    };
    writeln!(text, "units           {units}")?;
    let bodies = match extent.bodies.len() {
        1 => String::new(),
        several => format!(" in {several} bodies"),
    };
    writeln!(
        text,
        "size            {}D, {} nodes, {} cells{bodies}",
        extent.dimension, extent.nodes, extent.cells
    )
}

/// What moves, and the force that is missing.
fn missing(text: &mut String, failure: &ReportedFailure) -> std::fmt::Result {
    writeln!(text, "motion          {}", failure.words)?;
    let (sliding, opening) = (failure.sliding.len(), failure.opening.len());
    writeln!(text, "contacts        {sliding} slide, {opening} open")
}

fn totals(text: &mut String, report: &Report) -> std::fmt::Result {
    let totals = &report.totals;
    let (open, stick, slip) = (totals.open, totals.stick, totals.slip);
    let contacts = report.size.contacts;
    writeln!(
        text,
        "contacts        {contacts}: {open} open, {stick} stick, {slip} slip"
    )?;
    writeln!(text, "normal force    {}", number(totals.normal))?;
    writeln!(text, "friction        {}", vector(&totals.friction))?;
    writeln!(text, "contact force   {}", vector(&totals.contact_force))?;
    writeln!(
        text,
        "moment          {} about the origin",
        vector(&totals.moment)
    )?;
    let (area, slipping) = (number(totals.contact_area), number(totals.slip_area));
    writeln!(text, "contact area    {area}, slipping {slipping}")?;
    writeln!(text, "peak pressure   {}", number(totals.peak_pressure))
}

/// What is largest in the bodies, and what the supports carry.
fn extremes(text: &mut String, report: &Report) -> std::fmt::Result {
    let found = &report.extremes;
    let place = |largest: Largest, what: &str| match report.size.bodies.as_slice() {
        [_] => format!("{what} {}", largest.place),
        bodies => {
            let body = bodies.get(largest.body).map_or("", |body| &body.name);
            format!("body `{body}`, {what} {}", largest.place)
        }
    };
    for (name, largest, what) in [
        ("displacement", found.displacement, "node"),
        ("von Mises", found.von_mises, "at the centre of cell"),
    ] {
        let (value, place) = (number(largest.value), place(largest, what));
        writeln!(text, "{name:<16}{value} at most, {place}")?;
    }
    for body in &report.rigid_bodies {
        let (name, moved) = (&body.name, vector(&body.displacement));
        let (turned, force) = (vector(&body.rotation), vector(&body.contact.force));
        let moment = vector(&body.contact.moment);
        writeln!(
            text,
            "rigid body      `{name}` moves by {moved}, turns by {turned}"
        )?;
        writeln!(
            text,
            "                contact force {force}, moment {moment} on it"
        )?;
    }
    for bolt in &report.bolts {
        let (name, force, shortening) = (&bolt.name, number(bolt.force), number(bolt.shortening));
        writeln!(
            text,
            "bolt            `{name}` carries {force}, shorter by {shortening}"
        )?;
    }
    for support in report.supports.iter().take(LISTED) {
        let (place, force) = (&support.place, vector(&support.force));
        writeln!(text, "support         {force} by {place}")?;
    }
    for group in report.rigid_groups.iter().take(LISTED) {
        writeln!(
            text,
            "rigid group     {}: moved {}, turned {}, held by {} and moment {}",
            group.place,
            vector(&group.displacement),
            vector(&group.rotation),
            vector(&group.force),
            vector(&group.moment)
        )?;
    }
    match report.supports.len().saturating_sub(LISTED) {
        0 => Ok(()),
        rest => writeln!(text, "  ... and {rest} more"),
    }
}

/// What the mesh leaves to be desired, as far as it was looked at.
fn quality(text: &mut String, report: &Report) -> std::fmt::Result {
    let mut parts = Vec::new();
    if let Some(oscillation) = report.quality.oscillation {
        parts.push(format!("pressure oscillates by {}", percent(oscillation)));
    }
    if let Some(estimate) = report.quality.stress_error_estimate {
        parts.push(format!("stress is wrong by about {}", percent(estimate)));
    }
    if let Some(bound) = report.quality.stress_error_bound {
        parts.push(format!("stress is wrong by {} at most", percent(bound)));
    }
    match parts.is_empty() {
        true => Ok(()),
        false => writeln!(text, "mesh            {}", parts.join(", ")),
    }
}

fn percent(part: f64) -> String {
    match 100.0 * part {
        percent if percent >= 0.1 => format!("{percent:.1} %"),
        percent => format!("{percent:.0e} %"),
    }
}

/// Where the work of a load history went so far.
fn energy(text: &mut String, report: &Report) -> std::fmt::Result {
    let Some(step) = &report.step else {
        return Ok(());
    };
    let total = &step.total;
    let work = number(total.loads + total.supports + total.obstacles + total.fits);
    let (elastic, friction) = (number(total.elastic), number(total.dissipation));
    let open = size(total.closure);
    writeln!(
        text,
        "energy          work {work}, elastic {elastic}, friction {friction}, unexplained {open}"
    )?;
    let Some(halving) = step.halving else {
        return Ok(());
    };
    let (parts, contacts) = (halving.parts, halving.contacts);
    let friction = size(halving.dissipation);
    writeln!(
        text,
        "halving         the step's {parts} parts changes friction by {friction}, {contacts} contacts"
    )
}

/// One line per contact pair, if there are several; laws beyond Coulomb's.
fn pairs(text: &mut String, report: &Report) -> std::fmt::Result {
    let pairs = &report.totals.pairs;
    for pair in pairs.iter().take(LISTED) {
        if let Some(law) = &pair.law {
            writeln!(text, "law             {law}, at {}", pair.place)?;
        }
    }
    if pairs.len() < 2 {
        return Ok(());
    }
    writeln!(
        text,
        "pairs               open  stick   slip  normal force  peak pressure"
    )?;
    for pair in pairs.iter().take(LISTED) {
        let (place, totals) = (&pair.place, &pair.totals);
        let (open, stick, slip) = (totals.open, totals.stick, totals.slip);
        let (normal, peak) = (number(totals.normal), number(totals.peak_pressure));
        writeln!(
            text,
            "  {place:<16} {open:>5} {stick:>6} {slip:>6} {normal:>13} {peak:>14}"
        )?;
    }
    match pairs.len().saturating_sub(LISTED) {
        0 => Ok(()),
        rest => writeln!(text, "  ... and {rest} more"),
    }
}

/// What was asked for beside the state: the error of a total, a parameter that was found, and what the totals gain per
/// unit of a parameter; a kink has both sides.
fn asked(text: &mut String, report: &Report) -> std::fmt::Result {
    if let Some(accuracy) = &report.accuracy {
        writeln!(text, "accuracy        {}", accuracy.words())?;
        for level in &accuracy.levels {
            let value = number(level.value);
            writeln!(text, "  {:>9} cells {value:>17}", level.cells)?;
        }
    }
    if let Some(found) = &report.found {
        writeln!(text, "found           {}", found.words())?;
    }
    for sensitivity in &report.sensitivity {
        writeln!(text, "per unit of     {}", sensitivity.parameter)?;
        let felt = |derivative: &&ReportedDerivative| {
            derivative.growing != 0.0 || derivative.falling.is_some()
        };
        for derivative in sensitivity.derivatives.iter().filter(felt) {
            let growing = number(derivative.growing);
            let falling = derivative.falling.map_or_else(String::new, |falling| {
                format!("  (KINK: {} as it falls)", number(falling))
            });
            writeln!(text, "  {:<16} {growing:>13}{falling}", derivative.of)?;
        }
    }
    Ok(())
}

fn violations(text: &mut String, report: &Report) -> std::fmt::Result {
    let laws = &report.certificate;
    writeln!(text, "worst violation         size    scaled")?;
    for (name, worst) in [
        ("penetration", laws.penetration),
        ("tension", laws.tension),
        ("complementarity", laws.complementarity),
        ("friction bound", laws.disc_excess),
        ("dissipation", laws.dissipation_defect),
    ] {
        let place = format!("contact {}", worst.contact);
        violation(text, name, worst.value, worst.scaled, &place)?;
    }
    if let Some(ReportedDefect { value, scaled }) = laws.equilibrium {
        violation(text, "free motions", value, scaled, "")?;
    }
    balances(text, &laws.bodies)?;
    exchange(text, report)
}

/// Equilibrium where it is worst; the body's name only says something beside another body.
fn balances(text: &mut String, bodies: &[ReportedBalance]) -> std::fmt::Result {
    let of = |body: &ReportedBalance, node: String| match (bodies.len(), node.as_str()) {
        (1, _) => node,
        (_, "") => format!("body `{}`", body.name),
        (_, node) => format!("body `{}`, {node}", body.name),
    };
    if let Some(body) = worst(bodies, |body| body.equilibrium.scaled) {
        let nodal = body.equilibrium;
        let place = of(body, format!("node {}", nodal.node));
        violation(text, "equilibrium", nodal.value, nodal.scaled, &place)?;
    }
    type Sum = fn(&ReportedBalance) -> ReportedDefect;
    let sums: [(&str, Sum); 2] = [
        ("sum of forces", |body| body.force_defect),
        ("sum of moments", |body| body.moment_defect),
    ];
    for (name, defect) in sums {
        if let Some(body) = worst(bodies, |body| defect(body).scaled) {
            let (defect, place) = (defect(body), of(body, String::new()));
            violation(text, name, defect.value, defect.scaled, &place)?;
        }
    }
    Ok(())
}

/// Action and reaction where they differ most, if any contact is between bodies.
fn exchange(text: &mut String, report: &Report) -> std::fmt::Result {
    let pairs = report.totals.pairs.iter();
    let exchanges: Vec<_> = pairs
        .filter_map(|pair| Some((&pair.place, pair.exchange.as_ref()?.force_defect)))
        .collect();
    match worst(&exchanges, |(_, defect)| defect.scaled) {
        Some((place, defect)) => {
            violation(text, "force exchange", defect.value, defect.scaled, place)
        }
        None => Ok(()),
    }
}

/// The first of the largest.
fn worst<T>(items: &[T], size: impl Fn(&T) -> f64) -> Option<&T> {
    let reversed = items.iter().rev();
    reversed.max_by(|a, b| size(a).total_cmp(&size(b)))
}

/// One line of the table; the place only says something where there is a violation.
fn violation(
    text: &mut String,
    name: &str,
    value: f64,
    scaled: f64,
    place: &str,
) -> std::fmt::Result {
    let place = if value == 0.0 { "" } else { place };
    let (value, scaled) = (size(value), size(scaled));
    let line = format!("  {name:<16} {value:>9} {scaled:>9}  {place}");
    writeln!(text, "{}", line.trim_end())
}

/// What other starts led to, and how much friction the alternation takes.
fn trust(text: &mut String, report: &Report) -> std::fmt::Result {
    match &report.trust {
        Some(trust) => writeln!(text, "trust           {}", trust.words),
        None => Ok(()),
    }
}

fn work(text: &mut String, report: &Report) -> std::fmt::Result {
    let work = &report.work;
    writeln!(
        text,
        "work            {}{}, {}, {}, {}",
        counted(work.factorisations, "factorisation"),
        precision(work),
        counted(work.sweeps, "sweep"),
        counted(work.cone_iterations, "cone iteration"),
        counted(work.newton_steps, "Newton step"),
    )?;
    if let Some(words) = work.ranks_in_words() {
        writeln!(text, "ranks           {words}")?;
    }
    let stages = work.seconds.by_stage();
    let spent: Vec<String> = stages
        .iter()
        .map(|(name, spent)| format!("{name} {spent:.3}"))
        .collect();
    let (total, [before, after]) = (work.seconds.total, [&spent[..4], &spent[4..]]);
    writeln!(text, "seconds         {total:.3}: {},", before.join(", "))?;
    writeln!(text, "                {}", after.join(", "))
}

/// What is to be said of factors in single precision.
fn precision(work: &ReportedWork) -> String {
    match (&work.fallback, work.single_factors) {
        (Some(sign), _) => format!(" (single precision is not enough: {sign})"),
        (None, 0) => String::new(),
        (None, _) => format!(
            " in single precision with {}",
            counted(work.corrections, "correction")
        ),
    }
}

fn counted(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

fn vector(components: &[f64]) -> String {
    let components: Vec<String> = components.iter().map(|&c| number(c)).collect();
    match components.as_slice() {
        [single] => single.clone(),
        several => format!("({})", several.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_six_digits_in_every_unit() {
        let found = [0.0, 9.999_999_9, 0.04, 12.5, -99999.4, 1.40536e6, 3.2e-9].map(number);
        let expected = [
            "0",
            "10.0000",
            "0.0400000",
            "12.5000",
            "-99999.4",
            "1.40536e6",
            "3.20000e-9",
        ];
        assert_eq!(found, expected);
    }

    #[test]
    fn one_sweep_is_no_sweeps() {
        assert_eq!(
            (counted(1, "sweep"), counted(2, "sweep")),
            ("1 sweep".into(), "2 sweeps".into())
        );
        assert_eq!(
            (vector(&[2.0]), vector(&[2.0, 0.0])),
            ("2.00000".into(), "(2.00000, 0)".into())
        );
    }
}
