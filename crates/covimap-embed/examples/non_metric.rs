//! A map of a town from the times that buses take.
//!
//! `cargo run --release -p covimap-embed --example non_metric`
//!
//! Longer trips take longer, but not in proportion: everybody waits for the bus, and it is faster
//! out of town. How much is not known. Scaling that takes minutes for distances bends the map;
//! ordinal scaling takes their order only, and a spline finds the curve.

use covimap_embed::{
    Correspondence, Pair, PairDistances, Point, ProcrustesOptions, Smacof, Ties, Transformation, procrustes,
    random_starts, torgerson_start,
};

/// Minutes from place to place, in whole numbers: there are ties.
fn minutes(kilometres: f64) -> f64 {
    (25.0 * kilometres.powf(0.4)).round()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // 24 places on a spiral through the town.
    let town: Vec<Point> = (0..24)
        .map(|k| {
            let (radius, angle) = (0.9 * f64::from(k).sqrt(), 2.4 * f64::from(k));
            [radius * angle.cos(), radius * angle.sin()]
        })
        .collect();
    let ends = (0..town.len()).flat_map(|i| (i + 1..town.len()).map(move |j| (i, j)));
    let pair = |(i, j): (usize, usize)| {
        let distance = (town[i][0] - town[j][0]).hypot(town[i][1] - town[j][1]);
        Pair { i: i as u32, j: j as u32, distance: minutes(distance), weight: 1.0 }
    };
    let pairs = PairDistances::new(town.len(), ends.map(pair).collect())?;

    // Ordinal scaling has more poor minima than metric scaling: several starts, the best is kept.
    let mut starts = random_starts(&pairs, 9, 1);
    starts.push(torgerson_start(&pairs)?);
    println!("{:<22}{:>10}{:>16}", "", "stress-1", "error / km");
    for (name, transformation) in [
        ("minutes", Transformation::Ratio),
        ("interval", Transformation::Interval),
        ("ordinal, ties kept", Transformation::Ordinal(Ties::Secondary)),
        ("ordinal, ties free", Transformation::Ordinal(Ties::Primary)),
        ("spline", Transformation::MSpline { degree: 2, interior_knots: 2 }),
    ] {
        let how = Smacof { transformation, relocations: 5, ..Smacof::default() };
        let best = how.from_starts(&pairs, &starts)?.best.embedding;
        let both = best.points.iter().zip(&town);
        let both: Vec<_> =
            both.map(|(&source, &target)| Correspondence { source, target, weight: 1.0 }).collect();
        let error = procrustes(&both, ProcrustesOptions::default())?.rmse;
        println!("{name:<22}{:>10.4}{error:>16.3}", best.stress1);
    }
    Ok(())
}
