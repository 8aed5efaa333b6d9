//! Convex hulls: the shape of a region.

use super::Pixel;

/// Corners of the convex hull, counter-clockwise where y points up (A. M. Andrew's monotone
/// chain). One or two points, or points on a line, give the ends.
pub(super) fn convex(mut points: Vec<Pixel>) -> Vec<Pixel> {
    points.sort_unstable_by(|a, b| a[0].total_cmp(&b[0]).then(a[1].total_cmp(&b[1])));
    points.dedup();
    if points.len() < 3 {
        return points;
    }
    let mut corners = half(points.iter());
    corners.extend(half(points.iter().rev()));
    corners
}

/// One side of the hull, without its last corner.
fn half<'a>(points: impl Iterator<Item = &'a Pixel>) -> Vec<Pixel> {
    let mut side: Vec<Pixel> = Vec::new();
    for &point in points {
        while let [.., a, b] = side[..] {
            if (b[0] - a[0]) * (point[1] - a[1]) - (b[1] - a[1]) * (point[0] - a[0]) > 0.0 {
                break;
            }
            side.pop();
        }
        side.push(point);
    }
    side.pop();
    side
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inner_points_and_points_on_sides_are_no_corners() {
        let square = vec![[0.0, 0.0], [1.0, 1.0], [0.5, 0.5], [1.0, 0.0], [0.5, 0.0], [0.0, 1.0], [0.0, 0.0]];
        assert_eq!(convex(square), [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
    }

    #[test]
    fn degenerate_sets_give_their_ends() {
        assert_eq!(convex(vec![]), Vec::<Pixel>::new());
        assert_eq!(convex(vec![[2.0, 3.0]; 4]), [[2.0, 3.0]]);
        assert_eq!(convex(vec![[1.0, 1.0], [0.0, 0.0], [3.0, 3.0]]), [[0.0, 0.0], [3.0, 3.0]]);
    }
}
