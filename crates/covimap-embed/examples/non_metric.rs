//! A map from words: of each two places only how far apart they feel is known.
//!
//! `cargo run --release -p covimap-embed --example non_metric`
//!
//! Travellers call a trip "next door", "near", "a way", "far" or "the other end". The words are in
//! order and say nothing more: nobody knows how much longer "far" is than "near". Scaling that
//! takes their numbers 1 to 5 for distances is compared with ordinal scaling, which takes their
//! order only, and which ties may break up or not.

use covimap_embed::{
    Correspondence, Pair, PairDistances, Point, ProcrustesOptions, Smacof, Ties, Transformation, procrustes,
    random_starts, torgerson_start,
};

/// Up to which distance in kilometres each word but the last is used.
const WORDS: [(&str, f64); 4] = [("next door", 0.6), ("near", 1.6), ("a way", 2.4), ("far", 6.0)];

fn word(distance: f64) -> usize {
    WORDS.iter().take_while(|(_, up_to)| distance > *up_to).count()
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
        Pair { i: i as u32, j: j as u32, distance: (1 + word(distance)) as f64, weight: 1.0 }
    };
    let pairs = PairDistances::new(town.len(), ends.map(pair).collect())?;

    // Ordinal scaling has more poor minima than metric scaling: several starts, the best is kept.
    let mut starts = random_starts(&pairs, 9, 1);
    starts.push(torgerson_start(&pairs)?);
    println!("{:<22}{:>10}{:>16}", "", "stress-1", "error / km");
    for (name, transformation) in [
        ("numbers of the words", Transformation::Ratio),
        ("interval", Transformation::Interval),
        ("ordinal, ties kept", Transformation::Ordinal(Ties::Secondary)),
        ("ordinal, ties free", Transformation::Ordinal(Ties::Primary)),
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
