//! Steps: what every load and support is at every instant that is solved.
//!
//! ```text
//! no amplitude    from its value at the end of the step before to the stated one, linearly
//! amplitude a     stated value · a(t)
//! ```
//!
//! Instants are the ends of steps and, inside them, the times of the amplitudes in use. Loads that a
//! step does not state persist, unless it says OP=NEW; then they end. Those that it states add up, each with its own
//! amplitude, in place of what was there before.

use std::collections::BTreeMap;
use std::rc::Rc;

use super::amplitude::{Amplitude, Amplitudes};
use super::load::{Reader, Slot};
use super::statement::{Notes, Stated, Statement, Step};
use crate::error::Error;
use crate::mesh_file::abaqus::Card;

/// Instants, and what every load and support is at each.
#[derive(Debug, Default)]
pub(super) struct History {
    /// Rising times.
    pub(super) instants: Vec<f64>,
    /// Number of the step, from 1, that each is in.
    pub(super) steps: Vec<usize>,
    /// Values at the instants.
    pub(super) values: BTreeMap<Slot, Vec<f64>>,
}

/// Name of an amplitude, and the bits of its delay.
type Named = (String, u64);

/// What a load or a support follows.
type Follows = Option<(Named, Rc<Amplitude>)>;

/// A load or a support as a step leaves it.
#[derive(Clone, Debug)]
struct Entry {
    stated: f64,
    amplitude: Option<Rc<Amplitude>>,
    /// Whether it is there at once and does not grow over the step.
    at_once: bool,
    /// Its value when the step begins.
    start: f64,
    /// Number of the step that stated it last.
    step: usize,
}

/// The families of keywords that an OP=NEW ends.
const FAMILIES: [&[&str]; 4] = [
    &["BOUNDARY"],
    &["CLOAD"],
    &["DLOAD", "DSLOAD"],
    &["TEMPERATURE"],
];

/// The one of forces on faces and in cells.
const DISTRIBUTED: usize = 2;

fn family(slot: Slot) -> usize {
    match slot {
        Slot::Held(..) | Slot::Motion(..) | Slot::OwnMotion(..) | Slot::Shortening(_) => 0,
        Slot::Force(..) | Slot::OwnForce(..) | Slot::Wrench(..) | Slot::OwnWrench(..) => 1,
        Slot::Preload(_) => 1,
        Slot::Pressure(_) | Slot::SurfacePressure(_) => 2,
        Slot::Weight(..) | Slot::Gravity(..) | Slot::Spin(..) => 2,
        Slot::Heat(_) => 3,
        // Once locked, always: no keyword ends it.
        Slot::Lock(_) => FAMILIES.len(),
    }
}

/// Times closer than this part of a step are one: ends of steps are sums.
const NEAR: f64 = 1e-9;

/// The history while it is read.
struct Walk<'m, 'r> {
    reader: Reader<'r>,
    amplitudes: &'m Amplitudes,
    /// Of a load an entry per amplitude: they add up.
    entries: BTreeMap<(Slot, Option<Named>), Entry>,
    history: History,
    time: f64,
}

impl History {
    /// Goes through the steps.
    pub(super) fn new(
        statement: &Statement<'_, '_>,
        amplitudes: &Amplitudes,
        reader: Reader<'_>,
        notes: &mut Notes,
    ) -> Result<Self, Error> {
        let mut walk = Walk {
            reader,
            amplitudes,
            entries: BTreeMap::new(),
            history: Self::default(),
            time: 0.0,
        };
        let supports = statement.model.iter();
        for &stated in supports.filter(|(_, card)| card.name == "BOUNDARY") {
            walk.apply(stated, 0, false, notes)?;
        }
        for (number, step) in (1..).zip(&statement.steps) {
            walk.step(number, step, notes)?;
        }
        walk.history.values = walk.reader.sums(walk.history.values)?;
        Ok(walk.history)
    }
}

impl Walk<'_, '_> {
    fn step(&mut self, number: usize, step: &Step<'_, '_>, notes: &mut Notes) -> Result<(), Error> {
        let period = period(step.procedure, notes)?;
        let end = self.time + period;
        if end <= self.time {
            return Err(step
                .procedure
                .error(format!("period {period}; expected one above 0")));
        }
        step.card.one_of("AMPLITUDE", &["STEP", "RAMP"])?;
        let at_once = step.card.get("AMPLITUDE") == Some("STEP");
        let held = self
            .entries
            .keys()
            .filter(|(slot, _)| family(*slot) == 0)
            .count();
        self.end_families(step, at_once, notes);
        for &stated in step
            .cards
            .iter()
            .filter(|(_, card)| card.name != "MODELCHANGE")
        {
            self.apply(stated, number, at_once, notes)?;
        }
        self.check_supports(number, step, held)?;
        for time in self.instants(number, end) {
            self.record(number, time, period);
        }
        for entry in self.entries.values_mut() {
            entry.start = value(entry, number, end, self.time, period);
        }
        self.time = end;
        Ok(())
    }

    /// What OP=NEW ends: it falls to nothing, if the step does not state it again.
    fn end_families(&mut self, step: &Step<'_, '_>, at_once: bool, notes: &mut Notes) {
        for (at, keywords) in FAMILIES.iter().enumerate() {
            let of_family = |card: &Card<'_>| keywords.contains(&card.name.as_str());
            let cards = step.cards.iter().map(|(_, card)| card);
            let mut new = cards.filter(|card| of_family(card) && card.get("OP") == Some("NEW"));
            let Some(card) = new.next() else {
                continue;
            };
            let both = new.any(|other| other.name != card.name);
            let ended = self.entries.iter_mut();
            for ((slot, _), entry) in ended.filter(|((slot, _), _)| family(*slot) == at) {
                let of_surface = matches!(slot, Slot::SurfacePressure(_));
                let other = at == DISTRIBUTED && of_surface != (card.name == "DSLOAD");
                if other && !both && entry.stated != 0.0 {
                    notes.add(
                        card,
                        "`OP=NEW` ends loads of *DLOAD and of *DSLOAD, which CalculiX keeps in one list; Abaqus would \
                         keep those of the other keyword",
                    );
                }
                entry.stated = if at == 0 { f64::NAN } else { 0.0 };
                (entry.amplitude, entry.at_once) = (None, at_once);
            }
        }
    }

    fn apply(
        &mut self,
        stated: Stated<'_, '_>,
        step: usize,
        at_once: bool,
        notes: &mut Notes,
    ) -> Result<(), Error> {
        let card = stated.1;
        let (name, amplitude) = self.amplitude(card)?.unzip();
        for (slot, given) in self.reader.read(stated, notes)? {
            // Loads of one step add up; supports say the same twice; of temperatures the last one counts.
            let adds = [1, 2].contains(&family(slot));
            if adds {
                self.end_before(slot, step, at_once || amplitude.is_some());
            }
            let key = (slot, name.clone().filter(|_| adds));
            let entry = self.entries.entry(key).or_insert(Entry {
                stated: 0.0,
                amplitude: amplitude.clone(),
                at_once,
                start: 0.0,
                step: usize::MAX,
            });
            let again = entry.step == step;
            let scaled = entry.stated != 0.0 || given != 0.0;
            let other = (scaled && entry.amplitude != amplitude)
                || (family(slot) == 0 && entry.stated != given);
            if again && !adds && other {
                return Err(card.error("one node or face with two values in one step"));
            }
            entry.stated = if again && adds {
                entry.stated + given
            } else {
                given
            };
            (entry.at_once, entry.step) = (at_once, step);
            entry.amplitude.clone_from(&amplitude);
        }
        Ok(())
    }

    /// Ends what was stated of a load before this step, as it is stated anew; of spins those about any axis, as the axis may
    /// change.
    fn end_before(&mut self, slot: Slot, step: usize, at_once: bool) {
        let (first, last) = match slot {
            Slot::Spin(cell, _) => (Slot::Spin(cell, [0; 6]), Slot::Spin(cell, [u64::MAX; 6])),
            one => (one, one),
        };
        let before = self.entries.range_mut((first, None)..);
        let before = before.take_while(|((slot, _), _)| *slot <= last);
        for (_, entry) in before.filter(|(_, entry)| entry.step != step) {
            // Whichever card comes first.
            let again = entry.stated == 0.0 && entry.amplitude.is_none();
            entry.at_once = at_once || again && entry.at_once;
            (entry.stated, entry.amplitude) = (0.0, None);
        }
    }

    /// The amplitude that a card names, delayed as it says.
    fn amplitude(&self, card: &Card<'_>) -> Result<Follows, Error> {
        let Some(name) = card.get("AMPLITUDE") else {
            return match card.get("TIMEDELAY") {
                None => Ok(None),
                Some(_) => Err(card.error("`TIME DELAY` without an `AMPLITUDE`")),
            };
        };
        let unknown = || card.error(format!("amplitude `{name}` is not known"));
        let amplitude = self.amplitudes.get(name).ok_or_else(unknown)?;
        let delay = match card.get("TIMEDELAY") {
            None => 0.0,
            Some(word) => card.head(0).number_of(word, "a time")?,
        };
        let named = (name.to_owned(), delay.to_bits());
        Ok(Some((named, Rc::new(amplitude.delayed(delay)))))
    }

    /// Supports stand at every instant: none begins or ends on the way.
    fn check_supports(
        &self,
        number: usize,
        step: &Step<'_, '_>,
        before: usize,
    ) -> Result<(), Error> {
        let supports = self
            .entries
            .iter()
            .filter(|((slot, _), _)| family(*slot) == 0);
        let now = supports.clone().count();
        let boundary = step.cards.iter().find(|(_, card)| card.name == "BOUNDARY");
        let card = boundary.map_or(step.card, |(_, card)| card);
        if supports.clone().any(|(_, entry)| entry.stated.is_nan()) {
            return Err(card.error("`OP=NEW` frees what was held; supports must stay in all steps"));
        }
        match number > 1 && now > before {
            true => {
                Err(card.error("holds what was free before; supports must be there in all steps"))
            }
            false => Ok(()),
        }
    }

    /// Instants of a step: its end, and the times of amplitudes before it.
    fn instants(&self, number: usize, end: f64) -> Vec<f64> {
        let mut instants = vec![end];
        for entry in self.entries.values() {
            let Some(amplitude) = &entry.amplitude else {
                continue;
            };
            let start = if amplitude.total { 0.0 } else { self.time };
            if amplitude.total || entry.step.max(1) == number {
                let near = NEAR * (end - self.time);
                let inside = amplitude.times(self.time + near - start, end - near - start);
                instants.extend(inside.map(|time| time + start));
                instants.sort_by(f64::total_cmp);
                instants.dedup_by(|later, time| *later - *time <= near);
            }
        }
        instants
    }

    fn record(&mut self, number: usize, time: f64, period: f64) {
        let before = self.history.instants.len();
        self.history.instants.push(time);
        self.history.steps.push(number);
        for ((slot, _), entry) in &self.entries {
            let values = self.history.values.entry(*slot);
            let values = values.or_insert_with(|| vec![0.0; before]);
            values.resize(before + 1, 0.0);
            values[before] += value(entry, number, time, self.time, period);
        }
    }
}

/// The value of a load in a step that begins at `begin`.
fn value(entry: &Entry, number: usize, time: f64, begin: f64, period: f64) -> f64 {
    match &entry.amplitude {
        Some(amplitude) if amplitude.total => entry.stated * amplitude.at(time),
        Some(amplitude) if entry.step.max(1) == number => entry.stated * amplitude.at(time - begin),
        // In time of the step that stated it, which is over.
        Some(_) => entry.start,
        None if entry.at_once => entry.stated,
        // Exact at the end of the step.
        None if time >= begin + period => entry.stated,
        None => entry.start + (time - begin) / period * (entry.stated - entry.start),
    }
}

/// The duration of a static step.
fn period(card: &Card<'_>, notes: &mut Notes) -> Result<f64, Error> {
    card.only(&[
        "DIRECT",
        "SOLVER",
        "NLGEOM",
        "STABILIZE",
        "ALLSDTOL",
        "CONTINUE",
        "FACTOR",
    ])?;
    if card.get("STABILIZE").is_some() {
        notes.add(card, "`STABILIZE` is not needed here");
    }
    let Some(row) = card.rows(0).next() else {
        return Ok(1.0);
    };
    row.number(0, "an increment", 1.0)?;
    notes.add(
        card,
        "increments are not needed here: one state per step and time of an amplitude",
    );
    match row.number(1, "a period", 1.0)? {
        // As where it is left out.
        0.0 => Ok(1.0),
        period => Ok(period),
    }
}
