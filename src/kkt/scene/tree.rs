//! Which of many small boxes holds the point nearest to a given one.
//!
//! A binary tree of boxes, split at the median along the longest side; of two halves the nearer one is
//! looked at first, and a box farther away than the best find is left out.

/// Items in a leaf.
const LEAF: usize = 4;

/// Lowest and highest corner of a box, in metre.
pub(super) type Bounds = [[f64; 3]; 2];

/// Boxes by place.
#[derive(Clone, Debug, Default)]
pub(super) struct Tree {
    branches: Vec<Branch>,
    /// Numbers of the items, those of a leaf side by side.
    items: Vec<usize>,
}

#[derive(Clone, Debug)]
struct Branch {
    bounds: Bounds,
    /// Positions in the list of items.
    range: [usize; 2],
    /// The halves; none of a leaf.
    halves: Option<[usize; 2]>,
}

impl Tree {
    pub(super) fn new(bounds: &[Bounds]) -> Self {
        let mut tree = Self {
            branches: Vec::new(),
            items: (0..bounds.len()).collect(),
        };
        if !bounds.is_empty() {
            tree.grow(bounds, [0, bounds.len()]);
        }
        tree
    }

    fn grow(&mut self, bounds: &[Bounds], range: [usize; 2]) -> usize {
        let items = &mut self.items[range[0]..range[1]];
        let around = around(items.iter().map(|&item| &bounds[item]));
        let number = self.branches.len();
        self.branches.push(Branch {
            bounds: around,
            range,
            halves: None,
        });
        if items.len() > LEAF {
            let side = |axis: usize| around[1][axis] - around[0][axis];
            let axis = (0..3).fold(0, |longest, axis| match side(axis) > side(longest) {
                true => axis,
                false => longest,
            });
            let middle = items.len() / 2;
            let at = |item: &usize| bounds[*item][0][axis] + bounds[*item][1][axis];
            items.select_nth_unstable_by(middle, |a, b| at(a).total_cmp(&at(b)));
            let middle = range[0] + middle;
            let first = self.grow(bounds, [range[0], middle]);
            let second = self.grow(bounds, [middle, range[1]]);
            self.branches[number].halves = Some([first, second]);
        }
        number
    }

    /// Calls `measure` with items, which gives the square of their distance from the point or none for
    /// one that does not count, until no other can be nearer than the nearest.
    pub(super) fn nearest(&self, point: [f64; 3], mut measure: impl FnMut(usize) -> Option<f64>) {
        let mut best = f64::INFINITY;
        let mut open = vec![0];
        while let Some(number) = open.pop() {
            let Some(branch) = self.branches.get(number) else {
                continue;
            };
            if square(&branch.bounds, point) > best {
                continue;
            }
            if let Some(mut halves) = branch.halves {
                let away = halves.map(|half| square(&self.branches[half].bounds, point));
                if away[0] < away[1] {
                    halves.swap(0, 1);
                }
                open.extend(halves);
                continue;
            }
            for &item in &self.items[branch.range[0]..branch.range[1]] {
                best = measure(item).unwrap_or(f64::INFINITY).min(best);
            }
        }
    }
}

fn around<'a>(boxes: impl Iterator<Item = &'a Bounds>) -> Bounds {
    let nothing = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    boxes.fold(nothing, |[low, high], one| {
        [
            std::array::from_fn(|axis| low[axis].min(one[0][axis])),
            std::array::from_fn(|axis| high[axis].max(one[1][axis])),
        ]
    })
}

/// Square of the distance of a point from a box.
fn square(bounds: &Bounds, point: [f64; 3]) -> f64 {
    let beside = (0..3).map(|axis| {
        let below = bounds[0][axis] - point[axis];
        below.max(point[axis] - bounds[1][axis]).max(0.0)
    });
    beside.map(|away| away * away).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_of_a_lattice_is_found_without_looking_at_all() {
        let points: Vec<[f64; 3]> = (0..1000)
            .map(|k| {
                [
                    f64::from(k % 10),
                    f64::from(k / 10 % 10),
                    f64::from(k / 100),
                ]
            })
            .collect();
        let bounds: Vec<Bounds> = points.iter().map(|&x| [x, x]).collect();
        let tree = Tree::new(&bounds);
        for (sought, expected) in [([3.2, 6.9, 2.4], 273), ([-5.0, 20.0, 9.9], 990)] {
            let (mut best, mut nearest, mut looked) = (f64::INFINITY, usize::MAX, 0);
            tree.nearest(sought, |item| {
                looked += 1;
                let square = square(&bounds[item], sought);
                if square < best {
                    (best, nearest) = (square, item);
                }
                Some(square)
            });
            assert_eq!(nearest, expected);
            assert!(looked < 60, "{looked}");
        }
        Tree::new(&[]).nearest([0.0; 3], |_| Some(0.0));
    }
}
