use super::*;
use crate::fixtures::links_where;

/// Links of some frequencies, as a link graph gives them.
fn links(n: usize, frequency: impl Fn(usize, usize) -> Option<f64>) -> PairDistances {
    links_where(n, |i, j| Some((-ALPHA * frequency(i, j)?.ln()).sqrt())).to_pairs()
}

#[test]
fn terms_computed_by_hand() {
    // A chain 0-1-2 of frequencies 1/2 and 1/5: odds of 1 and 4, and a path of 5. Of the nine relative errors the
    // path stands for all that are no links, 9 / 2 for each link.
    let chain =
        links(3, |i, j| [(0, 1, 0.5), (1, 2, 0.2)].into_iter().find(|l| (l.0, l.1) == (i, j)).map(|l| l.2));
    let Network { terms, pull, start } = Network::new(&chain).unwrap();
    let wanted = [(0, 1, 1.0, 1.0), (0, 2, 5.0, 9.0 / 25.0), (1, 2, 4.0, 1.0 / 16.0)];
    assert_eq!((terms.pairs().len(), pull), (3, 4.5));
    for (pair, (i, j, length, weight)) in terms.pairs().iter().zip(wanted) {
        assert_eq!((pair.i, pair.j), (i, j));
        assert!((pair.distance - length).abs() < 1e-12 && (pair.weight - weight).abs() < 1e-12, "{pair:?}");
    }
    let length = |i: usize, j: usize| (start[i][0] - start[j][0]).hypot(start[i][1] - start[j][1]);
    assert!((length(0, 2) - 5.0).abs() < 1e-9, "{start:?}");
}

#[test]
fn twins_have_a_length() {
    let twins = links(3, |i, j| Some(if (i, j) == (0, 1) { 1.0 - 1e-12 } else { 0.5 }));
    assert_eq!(Network::new(&twins).unwrap().terms.pairs()[0].distance, LEAST_ODDS);
}

#[test]
fn rare_links_are_no_shortcuts() {
    // Forty in a row, each linked to the next two, and the ends to each other by a link that is rarer than the row is long.
    let row = links(40, |i, j| match j - i {
        1 => Some(0.5),
        2 => Some(0.3),
        39 => Some(0.001),
        _ => None,
    });
    let Network { terms, start, .. } = Network::new(&row).unwrap();
    let ends = terms.pairs().iter().find(|pair| (pair.i, pair.j) == (0, 39)).unwrap();
    assert!((ends.distance - 999.0).abs() < 1e-6, "{ends:?}");
    let along = |i: usize| (start[i][0] - start[0][0]).hypot(start[i][1] - start[0][1]);
    assert!((1..39).all(|i| along(i) < along(i + 1)), "{start:?}");
}
