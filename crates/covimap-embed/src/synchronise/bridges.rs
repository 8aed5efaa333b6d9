//! Edges that lie on no cycle, and so are checked by no other edge.

/// For each edge of a graph of `n` nodes, whether its removal cuts two nodes apart. Parallel edges
/// are no bridges. Depth-first search with low points, `O(n + m)`.
///
/// R. E. Tarjan, "A note on finding the bridges of a graph", Inf. Process. Lett. 2(6), 1974.
pub(super) fn bridges(n: usize, edges: &[(u32, u32)]) -> Vec<bool> {
    let mut incident: Vec<Vec<(usize, usize)>> = vec![Vec::new(); n];
    for (k, &(a, b)) in edges.iter().enumerate() {
        incident[a as usize].push((b as usize, k));
        incident[b as usize].push((a as usize, k));
    }
    let mut search =
        Search { incident, found: vec![0; n], low: vec![0; n], count: 0, bridge: vec![false; edges.len()] };
    for root in 0..n {
        if search.found[root] == 0 {
            search.from(root);
        }
    }
    search.bridge
}

struct Search {
    /// `(other node, edge)` of each node.
    incident: Vec<Vec<(usize, usize)>>,
    /// Order of discovery from 1; 0 for not yet.
    found: Vec<usize>,
    /// The earliest node that an edge from the subtree reaches.
    low: Vec<usize>,
    count: usize,
    bridge: Vec<bool>,
}

impl Search {
    fn discover(&mut self, node: usize) {
        self.count += 1;
        self.found[node] = self.count;
        self.low[node] = self.count;
    }

    /// Depth first, with the path in place of recursion.
    fn from(&mut self, root: usize) {
        self.discover(root);
        // Node, the edge that led to it, and how many of its edges have been looked at.
        let mut path: Vec<(usize, Option<usize>, usize)> = vec![(root, None, 0)];
        while let Some((node, led, next)) = path.last_mut() {
            let (node, led) = (*node, *led);
            if let Some(&(other, edge)) = self.incident[node].get(*next) {
                *next += 1;
                if self.found[other] == 0 {
                    self.discover(other);
                    path.push((other, Some(edge), 0));
                } else if led != Some(edge) {
                    self.low[node] = self.low[node].min(self.found[other]);
                }
                continue;
            }
            path.pop();
            if let (Some(&(parent, ..)), Some(edge)) = (path.last(), led) {
                self.bridge[edge] = self.low[node] == self.found[node];
                self.low[parent] = self.low[parent].min(self.low[node]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::laplacian::components;

    #[test]
    fn removing_a_bridge_cuts_the_graph_and_nothing_else_does() {
        // A triangle, a bridge, a pair of parallel edges, a leaf and a square; then the same
        // edges in another order.
        let mut edges = vec![
            (0, 1),
            (1, 2),
            (2, 0),
            (2, 3),
            (3, 4),
            (4, 3),
            (4, 5),
            (4, 6),
            (6, 7),
            (7, 8),
            (8, 9),
            (9, 6),
        ];
        for _ in 0..edges.len() {
            edges.rotate_left(5);
            for (k, found) in bridges(10, &edges).into_iter().enumerate() {
                let others = edges.iter().enumerate().filter(|&(other, _)| other != k).map(|(_, &edge)| edge);
                let (_, sizes) = components(10, others);
                assert_eq!(found, sizes.len() > 1, "{:?}", edges[k]);
            }
        }
    }

    #[test]
    fn a_graph_without_edges() {
        assert!(bridges(1, &[]).is_empty() && bridges(0, &[]).is_empty());
    }
}
