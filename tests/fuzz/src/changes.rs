//! Random changes to a JSON text that leave it JSON.

use serde_json::{Map, Number, Value};

/// Numbers that programs trip over.
const NUMBERS: [f64; 20] = [
    0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    3.0,
    0.3,
    1e-3,
    0.499_999_999,
    1e-9,
    1e9,
    1e16,
    -1e-300,
    1e-308,
    5e-324,
    1e154,
    1e300,
    1.797_693_134_862_315_7e308,
    -1e308,
    18_446_744_073_709_551_615.0,
];

/// Numbers out of a seed (xorshift64*).
struct Dice(u64);

impl Dice {
    fn below(&mut self, sides: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let number = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D);
        (number >> 33) as usize % sides.max(1)
    }
}

/// A few changes to a JSON text; none where it is not JSON.
#[must_use]
pub fn change(text: &[u8], seed: u32) -> Option<String> {
    let mut value: Value = serde_json::from_slice(text).ok()?;
    let mut dice = Dice(u64::from(seed) << 1 | 1);
    for _ in 0..8 {
        dice.below(2);
    }
    for _ in 0..=dice.below(4) {
        let total = count(&value);
        let donor = pick(&mut value, dice.below(total))?.clone();
        let total = count(&value);
        let place = pick(&mut value, dice.below(total))?;
        vary(place, donor, &mut dice);
    }
    serde_json::to_string(&value).ok()
}

/// Number of values inside a value, itself included.
fn count(value: &Value) -> usize {
    1 + match value {
        Value::Array(items) => items.iter().map(count).sum(),
        Value::Object(keys) => keys.values().map(count).sum(),
        _ => 0,
    }
}

/// The value at a place in the order of reading.
fn pick(value: &mut Value, place: usize) -> Option<&mut Value> {
    if place == 0 {
        return Some(value);
    }
    let mut left = place - 1;
    let inner: Vec<&mut Value> = match value {
        Value::Array(items) => items.iter_mut().collect(),
        Value::Object(keys) => keys.values_mut().collect(),
        _ => Vec::new(),
    };
    for value in inner {
        let size = count(value);
        if left < size {
            return pick(value, left);
        }
        left -= size;
    }
    None
}

fn vary(place: &mut Value, donor: Value, dice: &mut Dice) {
    let roll = dice.below(10);
    match place {
        Value::Number(number) if roll < 9 => {
            if let Some(new) = vary_number(number.as_f64().unwrap_or(0.0), dice) {
                *number = new;
            }
        }
        Value::Array(items) if roll < 8 => vary_list(items, donor, dice),
        Value::Object(keys) if roll < 8 => vary_keys(keys, donor, dice),
        Value::Null if roll < 5 => *place = Value::from(0),
        _ if roll < 3 => *place = Value::Null,
        _ => *place = donor,
    }
}

fn vary_number(old: f64, dice: &mut Dice) -> Option<Number> {
    let small = dice.below(5);
    match dice.below(8) {
        0 => Some(Number::from(small)),
        1 => Number::from_f64(NUMBERS[dice.below(NUMBERS.len())]),
        2 => Number::from_f64(-old),
        3 => Number::from_f64(old * 10_f64.powi(dice.below(41) as i32 - 20)),
        4 => Number::from_f64(old * (0.5 + dice.below(1000) as f64 / 500.0)),
        5 => Number::from_f64(old + small as f64 - 2.0),
        6 if old.fract() == 0.0 && (0.0..9.0).contains(&old) => {
            Some(Number::from(old as usize + 1))
        }
        _ => Number::from_f64(old * (1.0 + f64::EPSILON * small as f64)),
    }
}

fn vary_list(items: &mut Vec<Value>, donor: Value, dice: &mut Dice) {
    let at = dice.below(items.len());
    match dice.below(5) {
        0 => items.push(donor),
        1 if !items.is_empty() => {
            items.remove(at);
        }
        2 if !items.is_empty() => items.push(items[at].clone()),
        3 if !items.is_empty() => {
            let other = dice.below(items.len());
            items.swap(at, other);
        }
        _ if !items.is_empty() => items[at] = donor,
        _ => items.push(donor),
    }
}

fn vary_keys(keys: &mut Map<String, Value>, donor: Value, dice: &mut Dice) {
    let at = dice.below(keys.len());
    let Some(key) = keys.keys().nth(at).cloned() else {
        return;
    };
    match dice.below(3) {
        0 => {
            keys.remove(&key);
        }
        1 => {
            keys.insert(key, donor);
        }
        _ => {
            // Keys of the donor come along: supports get loads' keys and the like.
            if let Value::Object(more) = donor {
                keys.extend(more);
            }
        }
    }
}
