use super::*;
use crate::fixtures::{distance, exact_links, links_where, scattered};
use crate::{Link, SeamsReport};

/// The shape of a graph whose landmarks are in two regions of two branches, `first` of them in the larger.
fn shape(graph: &LinkGraph, first: usize) -> Shape {
    let n = graph.landmarks() as u32;
    let members: Vec<u32> = (0..n).collect();
    let (a, b) = members.split_at(first);
    let cover = RegionCover::of_members(n as usize, &[a, b]);
    let stitched = Stitched { points: Vec::new(), branch_of: vec![0, 1], seams: SeamsReport::default() };
    Shape::of(graph, &cover, &stitched)
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
    let terms = Shape { pull: 0.1 }.terms(&links).unwrap();
    let [first, path, last] = terms.pairs() else { panic!("{terms:?}") };
    assert_eq!([first, last], [&links.pairs()[0], &links.pairs()[1]]);
    assert_eq!((path.i, path.j, path.distance), (0, 2, 3.0));
    assert!((path.weight - 1.3 / 9.0).abs() < 1e-15, "{path:?}");
    assert_eq!(*Shape { pull: 0.0 }.terms(&links).unwrap(), links);
}

#[test]
fn paths_pull_where_links_are_few_and_most_sides_are_guesses() {
    let sparse = exact_links(&scattered(120, [4.0, 4.0], 2), 1.0);
    let dense = exact_links(&scattered(120, [2.0, 2.0], 2), 1.0);
    assert!(sparse.link_count() < 1200 && dense.link_count() >= 1200);
    assert_eq!(shape(&sparse, 59).pull, 1.0);
    // Half of the landmarks in one branch are enough, and so are ten links a landmark.
    assert_eq!(shape(&sparse, 60).pull, 0.0);
    assert_eq!(shape(&dense, 59).pull, 0.0);
}

#[test]
fn a_map_that_is_sure_begins_where_it_was_stitched() {
    let truth = scattered(30, [2.0, 2.0], 1);
    let links = exact_links(&truth, 1.0).to_pairs();
    assert_eq!(Shape { pull: 0.0 }.start(&links, truth.clone()).unwrap(), truth);
}

#[test]
fn few_noisy_links_along_a_strip_are_laid_out_in_their_order() {
    let mut truth = scattered(60, [60.0 / 8.0, 0.5], 3);
    truth.sort_by(|a, b| a[0].total_cmp(&b[0]));
    // Each landmark is linked to the next four; the lengths are off by up to a half.
    let noise = |i: usize, j: usize| 0.5 + ((i * 7919 + j * 104_729) % 1000) as f64 / 1000.0;
    let links =
        links_where(60, |i, j| (j - i <= 4).then(|| distance(truth[i], truth[j]).max(0.1) * noise(i, j)))
            .to_pairs();
    let start = Shape { pull: 1.0 }.start(&links, Vec::new()).unwrap();
    // Landmarks ten places apart in the strip never change places in the map.
    let along = |i: usize| (start[i][0] - start[0][0]).hypot(start[i][1] - start[0][1]);
    for i in 10..50 {
        assert!(along(i) < along(i + 10), "{i} {} {}", along(i), along(i + 10));
    }
}
