//! Which node lists (cells, patches) hold each node: a list of lists, turned around.

/// For every node the numbers of the lists that hold it, ascending, in one flat array.
#[derive(Clone, Debug)]
pub(crate) struct Incidence {
    offsets: Vec<usize>,
    lists: Vec<usize>,
}

impl Incidence {
    /// Turns `lists` of node numbers below `node_count` around, by counting.
    pub(crate) fn new<'a>(
        node_count: usize,
        lists: impl Iterator<Item = &'a [usize]> + Clone,
    ) -> Self {
        let mut offsets = vec![0; node_count + 1];
        for node in lists.clone().flatten() {
            offsets[node + 1] += 1;
        }
        for node in 0..node_count {
            offsets[node + 1] += offsets[node];
        }
        let mut next = offsets.clone();
        let mut turned = vec![0; offsets[node_count]];
        for (index, list) in lists.enumerate() {
            for node in list {
                turned[next[*node]] = index;
                next[*node] += 1;
            }
        }
        Self {
            offsets,
            lists: turned,
        }
    }

    /// Lists that hold `node`.
    pub(crate) fn of(&self, node: usize) -> &[usize] {
        &self.lists[self.offsets[node]..self.offsets[node + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_node_knows_the_lists_that_hold_it() {
        let lists: [&[usize]; 3] = [&[0, 2], &[3, 2], &[0, 3]];
        let found = Incidence::new(5, lists.into_iter());
        let around: Vec<&[usize]> = (0..5).map(|node| found.of(node)).collect();
        let expected: [&[usize]; 5] = [&[0, 2], &[], &[0, 1], &[1, 2], &[]];
        assert_eq!(around, expected);
    }
}
