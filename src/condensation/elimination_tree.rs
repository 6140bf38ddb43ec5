//! The elimination tree of a symmetric graph, and its postorder.
//!
//! The parent of a vertex is the first vertex after it that its elimination touches.
//! Numbering every subtree without gaps leaves the fill as it is and puts columns of
//! equal pattern side by side, where the factorisation finds them as one supernode.
//! J. W. H. Liu, The role of elimination trees in sparse factorization, SIAM J. Matrix
//! Anal. Appl. 11 (1990) 134–172.

/// No parent.
const ROOT: usize = usize::MAX;

/// A graph: the neighbours of vertex `v` are `neighbours[starts[v]..starts[v + 1]]`.
#[derive(Clone, Debug, Default)]
pub(super) struct Graph {
    /// Where each vertex's neighbours start, in METIS' integers.
    pub(super) starts: Vec<i32>,
    /// Neighbours, each edge from both ends, no loops.
    pub(super) neighbours: Vec<i32>,
}

impl Graph {
    /// Number of vertices.
    pub(super) fn vertices(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Neighbours of a vertex.
    pub(super) fn neighbours(&self, vertex: usize) -> impl Iterator<Item = usize> + '_ {
        let range = self.starts[vertex] as usize..self.starts[vertex + 1] as usize;
        self.neighbours[range].iter().map(|&other| other as usize)
    }
}

/// Rearranges `order` (`order[k]`: vertex eliminated at step `k`) into a postorder of its tree.
pub(super) fn postorder(graph: &Graph, order: &[usize]) -> Vec<usize> {
    let parents = parents(graph, order);
    visit_children_first(&parents)
        .into_iter()
        .map(|step| order[step])
        .collect()
}

/// Parent of every step of the elimination (Liu's algorithm with shortened paths).
fn parents(graph: &Graph, order: &[usize]) -> Vec<usize> {
    let mut step_of = vec![0; order.len()];
    for (step, &vertex) in order.iter().enumerate() {
        step_of[vertex] = step;
    }
    let mut parents = vec![ROOT; order.len()];
    let mut ancestors = vec![ROOT; order.len()];
    for (step, &vertex) in order.iter().enumerate() {
        for neighbour in graph.neighbours(vertex) {
            let mut at = step_of[neighbour];
            while at < step {
                let next = std::mem::replace(&mut ancestors[at], step);
                if next == ROOT {
                    parents[at] = step;
                    break;
                }
                at = next;
            }
        }
    }
    parents
}

/// Steps in an order that takes every subtree in one piece, children before parents.
fn visit_children_first(parents: &[usize]) -> Vec<usize> {
    let mut first_child = vec![ROOT; parents.len()];
    let mut next_sibling = vec![ROOT; parents.len()];
    let mut roots = Vec::new();
    for (step, &parent) in parents.iter().enumerate().rev() {
        if parent == ROOT {
            roots.push(step);
        } else {
            next_sibling[step] = first_child[parent];
            first_child[parent] = step;
        }
    }
    // Parents first and backwards, then turned round: no recursion on deep trees.
    let mut visited = Vec::with_capacity(parents.len());
    roots.reverse();
    let mut stack = roots;
    while let Some(step) = stack.pop() {
        visited.push(step);
        let mut child = first_child[step];
        while child != ROOT {
            stack.push(child);
            child = next_sibling[child];
        }
    }
    visited.reverse();
    visited
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chain(vertices: i32) -> Graph {
        let mut graph = Graph {
            starts: vec![0],
            ..Graph::default()
        };
        for v in 0..vertices {
            let ends = [v - 1, v + 1];
            let inside = ends.into_iter().filter(|&w| w >= 0 && w < vertices);
            graph.neighbours.extend(inside);
            graph.starts.push(graph.neighbours.len() as i32);
        }
        graph
    }

    #[test]
    fn a_dissected_chain_has_its_separators_as_parents() {
        // 0-1-2-3-4-5-6: ends of both halves first, then their middles 1 and 5, last 3.
        // Steps: 0→0 6→1 2→2 4→3 1→4 5→5 3→6; vertices 0 and 2 hang on 1, 4 and 6 on 5.
        let order = [0, 6, 2, 4, 1, 5, 3];
        assert_eq!(parents(&chain(7), &order), [4, 5, 4, 5, 6, 6, ROOT]);
        // Postorder: both children of 1 before 1, both of 5 before 5, 3 last.
        let found = postorder(&chain(7), &order);
        assert_eq!(found, [0, 2, 1, 6, 4, 5, 3]);
    }

    #[test]
    fn every_vertex_of_a_graph_without_edges_is_a_root() {
        let graph = Graph {
            starts: vec![0; 4],
            neighbours: Vec::new(),
        };
        let mut found = postorder(&graph, &[2, 0, 1]);
        found.sort_unstable();
        assert_eq!(found, [0, 1, 2]);
    }
}
