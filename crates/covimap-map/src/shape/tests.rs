use super::*;
use crate::Link;
use crate::fixtures::{distance, exact_links, links_where, scattered};

fn chosen(graph: &LinkGraph) -> Shape {
    choose(graph, &AutoParams::default(), &Silent).unwrap()
}

/// Places on a straight strip, in order.
fn strip(n: usize) -> Vec<Point> {
    let mut points = scattered(n, [n as f64 / 8.0, 0.5], 3);
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

#[test]
fn terms_computed_by_hand() {
    // A chain 0-1-2 of lengths 1 and 2, weights 1 and 3: the path 0-2 is 3 long. The links have
    // sum w d^2 = 1 + 12 = 13, so for a pull of 0.1 the path has the weight 1.3 / 9.
    let row = |links: &[(u32, f64, f64)]| {
        links.iter().map(|&(to, distance, weight)| Link { to, distance, weight }).collect()
    };
    let rows = vec![row(&[(1, 1.0, 1.0)]), row(&[(0, 1.0, 1.0), (2, 2.0, 3.0)]), row(&[(1, 2.0, 3.0)])];
    let links = LinkGraph::from_rows(rows).to_pairs();
    let shape = Shape { from_paths: false, pull: 0.1 };
    let terms = shape.terms(&links).unwrap();
    let [first, path, last] = terms.pairs() else { panic!("{terms:?}") };
    assert_eq!([first, last], [&links.pairs()[0], &links.pairs()[1]]);
    assert_eq!((path.i, path.j, path.distance), (0, 2, 3.0));
    assert!((path.weight - 1.3 / 9.0).abs() < 1e-15, "{path:?}");
    assert_eq!(*Shape::PLAIN.terms(&links).unwrap(), links);
}

#[test]
fn well_linked_maps_and_complete_ones_stay_plain() {
    let dense = exact_links(&scattered(200, [4.0, 4.0], 1), 1.2);
    assert!(dense.link_count() >= ENOUGH_LINKS * 200, "{}", dense.link_count());
    assert_eq!(chosen(&dense), Shape::PLAIN);
    assert_eq!(chosen(&exact_links(&scattered(12, [1.0, 1.0], 1), 9.0)), Shape::PLAIN);
    assert_eq!(chosen(&exact_links(&[[0.0; 2], [1.0, 0.0], [2.0, 0.0]], 1.5)), Shape::PLAIN);
}

#[test]
fn exact_links_that_fix_the_shape_need_no_paths() {
    let graph = exact_links(&scattered(120, [4.0, 4.0], 2), 1.0);
    assert!(graph.link_count() < ENOUGH_LINKS * 120 && graph.components().len() == 1);
    assert_eq!(chosen(&graph), Shape::PLAIN);
}

#[test]
fn few_noisy_links_along_a_strip_are_pulled_straight() {
    let truth = strip(60);
    // Each landmark is linked to the next four; lengths are off by up to 60 %, the same for every run.
    let graph = links_where(60, |i, j| {
        let noise = (mixed((i as u32, j as u32)) % 1000) as f64 / 1000.0;
        (j - i <= 4).then(|| distance(truth[i], truth[j]).max(0.1) * (0.4 + 1.2 * noise))
    });
    assert!(chosen(&graph).pull > 0.0, "{:?}", chosen(&graph));
}

#[test]
fn the_spanning_tree_spans() {
    let graph = exact_links(&scattered(80, [3.0, 3.0], 5), 1.0);
    let tree = spanning_tree(&graph);
    assert_eq!(tree.len(), 79);
    let kept = graph.without(|i, j| tree.binary_search(&(i.min(j), i.max(j))).is_err());
    assert_eq!((kept.link_count(), kept.components().len()), (79, 1));
}
