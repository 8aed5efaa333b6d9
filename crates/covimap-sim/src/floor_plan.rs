//! Free space as tiles, and the walls and openings that follow from them.
//!
//! A floor is a set of rectangles whose insides do not meet. Where the edges of two tiles touch, the way
//! is open unless a thin partition stands there; every other piece of edge is a wall.

use crate::geometry::{Point, Rect, Segment};

/// An opening between two tiles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Portal {
    /// The two tiles, by number.
    pub tiles: [usize; 2],
    /// The opening itself, parallel to an axis.
    pub opening: Segment,
}

/// The floor of a world: where one can stand, what blocks the way, and where one tile leads to the next.
#[derive(Debug, Clone, PartialEq)]
pub struct FloorPlan {
    tiles: Vec<Rect>,
    partitions: Vec<Segment>,
    walls: Vec<Segment>,
    portals: Vec<Portal>,
}

/// A tile's edge or a partition on the line `coordinate[axis] = line`, from `low` to `high` along it.
#[derive(Clone, Copy)]
struct Edge {
    line: f64,
    low: f64,
    high: f64,
    role: Role,
}

#[derive(Clone, Copy, PartialEq)]
enum Role {
    /// The tile with this number lies below the line.
    Below(usize),
    /// The tile with this number lies above the line.
    Above(usize),
    /// A thin wall on the line.
    Partition,
}

impl FloorPlan {
    /// Works out walls and portals.
    ///
    /// Tiles may touch but not overlap. Edges that touch, and partitions, must lie on bit-equal
    /// coordinates. Time `O(n log n + sum k^2)` for `n` edges of which `k` share a line.
    pub(crate) fn new(tiles: Vec<Rect>, partitions: Vec<Segment>) -> Self {
        let mut plan = Self { tiles, walls: partitions.clone(), portals: Vec::new(), partitions };
        for axis in 0..2 {
            let mut edges = plan.edges(axis);
            edges.sort_by(|a, b| a.line.total_cmp(&b.line).then(a.low.total_cmp(&b.low)));
            for on_line in edges.chunk_by(|a, b| a.line.total_cmp(&b.line).is_eq()) {
                plan.settle_line(axis, on_line);
            }
        }
        plan
    }

    /// The same floor with tiles cut into equal pieces whose sides are not longer than `most`.
    pub(crate) fn refined(&self, most: f64) -> Self {
        let cuts = |tile: &Rect, axis: usize| -> Vec<[f64; 2]> {
            let (low, high) = (tile.min[axis], tile.max[axis]);
            let count = ((high - low) / most).ceil().max(1.0) as usize;
            let line = |index: usize| {
                // The outer lines stay bit-equal, or the pieces would no longer touch their neighbours.
                if index == count { high } else { low + index as f64 * ((high - low) / count as f64) }
            };
            (0..count).map(|index| [line(index), line(index + 1)]).collect()
        };
        let mut pieces = Vec::new();
        for tile in &self.tiles {
            let columns = cuts(tile, 0);
            for [bottom, top] in cuts(tile, 1) {
                pieces.extend(
                    columns.iter().map(|&[left, right]| Rect { min: [left, bottom], max: [right, top] }),
                );
            }
        }
        Self::new(pieces, self.partitions.clone())
    }

    /// The rectangles of free space.
    #[must_use]
    pub fn tiles(&self) -> &[Rect] {
        &self.tiles
    }

    /// Everything that blocks sight and way.
    #[must_use]
    pub fn walls(&self) -> &[Segment] {
        &self.walls
    }

    /// The openings between tiles.
    #[must_use]
    pub fn portals(&self) -> &[Portal] {
        &self.portals
    }

    /// The smallest rectangle around the floor.
    #[must_use]
    pub fn bounds(&self) -> Rect {
        let nothing = Rect { min: [f64::INFINITY; 2], max: [f64::NEG_INFINITY; 2] };
        self.tiles.iter().fold(nothing, |all, tile| all.union(tile))
    }

    /// Free area, square metres.
    #[must_use]
    pub fn area(&self) -> f64 {
        self.tiles.iter().map(Rect::area).sum()
    }

    fn edges(&self, axis: usize) -> Vec<Edge> {
        let along = 1 - axis;
        let of_tiles = self.tiles.iter().enumerate().flat_map(|(tile, rect)| {
            let (low, high) = (rect.min[along], rect.max[along]);
            [
                Edge { line: rect.max[axis], low, high, role: Role::Below(tile) },
                Edge { line: rect.min[axis], low, high, role: Role::Above(tile) },
            ]
        });
        let lies_on_line = |wall: &&Segment| wall.a[axis].total_cmp(&wall.b[axis]).is_eq();
        let of_partitions = self.partitions.iter().filter(lies_on_line).map(|wall| Edge {
            line: wall.a[axis],
            low: wall.a[along].min(wall.b[along]),
            high: wall.a[along].max(wall.b[along]),
            role: Role::Partition,
        });
        of_tiles.chain(of_partitions).collect()
    }

    /// Turns the edges on one line into walls, where only one side has a tile, and portals.
    fn settle_line(&mut self, axis: usize, edges: &[Edge]) {
        let segment = |(low, high): (f64, f64)| {
            let line = edges[0].line;
            let point = |along: f64| -> Point { if axis == 0 { [line, along] } else { [along, line] } };
            Segment { a: point(low), b: point(high) }
        };
        let with = |wanted: fn(&Role) -> bool| edges.iter().filter(move |edge| wanted(&edge.role));
        let below = || with(|role| matches!(role, Role::Below(_)));
        let above = || with(|role| matches!(role, Role::Above(_)));
        let partitions = || with(|role| matches!(role, Role::Partition)).map(|edge| (edge.low, edge.high));
        for edge in below() {
            let rest = without((edge.low, edge.high), above().map(|other| (other.low, other.high)));
            self.walls.extend(rest.into_iter().map(segment));
        }
        for edge in above() {
            let rest = without((edge.low, edge.high), below().map(|other| (other.low, other.high)));
            self.walls.extend(rest.into_iter().map(segment));
        }
        for lower in below() {
            for upper in above() {
                let (Role::Below(first), Role::Above(second)) = (lower.role, upper.role) else { continue };
                let shared = (lower.low.max(upper.low), lower.high.min(upper.high));
                let open = without(shared, partitions());
                self.portals.extend(
                    open.into_iter().map(|part| Portal { tiles: [first, second], opening: segment(part) }),
                );
            }
        }
    }
}

/// What is left of the interval after all cuts, which come in ascending order of their lower ends.
fn without(interval: (f64, f64), cuts: impl Iterator<Item = (f64, f64)>) -> Vec<(f64, f64)> {
    let (mut low, high) = interval;
    let mut rest = Vec::new();
    for (cut_low, cut_high) in cuts {
        if cut_high <= low || cut_low >= high {
            continue;
        }
        if cut_low > low {
            rest.push((low, cut_low));
        }
        low = cut_high;
    }
    if low < high {
        rest.push((low, high));
    }
    rest
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rect(min: Point, max: Point) -> Rect {
        Rect { min, max }
    }

    fn wall_length(plan: &FloorPlan) -> f64 {
        plan.walls().iter().map(Segment::length).sum()
    }

    #[test]
    fn a_single_tile_has_four_walls_and_no_portal() {
        let plan = FloorPlan::new(vec![rect([0.0, 0.0], [2.0, 1.0])], Vec::new());
        assert_eq!(plan.walls().len(), 4);
        assert!((wall_length(&plan) - 6.0).abs() < 1e-12);
        assert!(plan.portals().is_empty());
    }

    #[test]
    fn tiles_that_share_part_of_an_edge_are_open_there_but_for_the_partition() {
        // [0,1]x[0,2] and [1,3]x[1,4] share x = 1 from y = 1 to 2; a partition fills 1.0 to 1.25 and
        // 1.75 to 2.0 of it.
        let tiles = vec![rect([0.0, 0.0], [1.0, 2.0]), rect([1.0, 1.0], [3.0, 4.0])];
        let partitions =
            vec![Segment { a: [1.0, 1.0], b: [1.0, 1.25] }, Segment { a: [1.0, 2.0], b: [1.0, 1.75] }];
        let plan = FloorPlan::new(tiles, partitions);
        let opening = Segment { a: [1.0, 1.25], b: [1.0, 1.75] };
        assert_eq!(plan.portals(), [Portal { tiles: [0, 1], opening }]);
        // Outlines 6 + 10, less twice the shared metre, plus 0.5 of partitions.
        assert!((wall_length(&plan) - 14.5).abs() < 1e-12, "{}", wall_length(&plan));
    }

    #[test]
    fn tiles_that_touch_in_a_corner_are_not_joined() {
        let tiles = vec![rect([0.0, 0.0], [1.0, 1.0]), rect([1.0, 1.0], [2.0, 2.0])];
        let plan = FloorPlan::new(tiles, Vec::new());
        assert!(plan.portals().is_empty());
        assert!((wall_length(&plan) - 8.0).abs() < 1e-12);
    }

    #[test]
    fn refining_changes_neither_area_nor_walls() {
        let tiles = vec![rect([0.0, 0.0], [1.0, 2.0]), rect([1.0, 1.0], [3.0, 4.0])];
        let plan = FloorPlan::new(tiles, vec![Segment { a: [1.0, 1.0], b: [1.0, 1.25] }]);
        let fine = plan.refined(0.35);
        assert!(fine.tiles().iter().all(|tile| (0..2).all(|axis| tile.max[axis] - tile.min[axis] < 0.35)));
        assert!((fine.area() - plan.area()).abs() < 1e-12);
        assert!((wall_length(&fine) - wall_length(&plan)).abs() < 1e-12);
        // 3 x 6 and 6 x 9 pieces with 2 * 6 + 3 * 5 and 5 * 9 + 6 * 8 openings inside. On the shared edge the
        // lines at 1.25, 1.33, 1.67, 2 on both sides leave three openings.
        assert_eq!(fine.tiles().len(), 72);
        assert_eq!(fine.portals().len(), 27 + 93 + 3);
    }
}
