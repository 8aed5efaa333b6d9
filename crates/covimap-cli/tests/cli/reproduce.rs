//! `covimap reproduce`, at its smallest: one layout, 100 steps.

use crate::scratch::Scratch;

const SMALL: [&str; 6] = ["-q", "--layouts", "1", "--steps", "100", "-o"];

fn reproduced(names: &[&str]) -> Scratch {
    let scratch = Scratch::new();
    let run = scratch.succeeds(&[&["reproduce"], names, &SMALL, &["out"]].concat());
    assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("", ""));
    scratch
}

fn rows(scratch: &Scratch, file: &str) -> Vec<Vec<String>> {
    let text = scratch.read(file);
    text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

#[test]
fn an_experiment_gives_curves_a_figure_and_a_summary() {
    let scratch = reproduced(&["sim1"]);
    let table = rows(&scratch, "out/sim1.csv");
    assert_eq!(
        table[0].join(","),
        "experiment,setting,method,steps,runs,landmarks,information,delaunay_error,delaunay_se,\
         orientation_error,orientation_se"
    );
    for method in ["phi1", "phi1 + TIC", "phi2", "classical", "auto"] {
        let curve: Vec<_> = table.iter().filter(|row| row[2] == method).collect();
        assert_eq!(curve.iter().map(|row| row[3].as_str()).collect::<Vec<_>>(), ["20", "50", "100"]);
        for row in curve {
            assert!((0.0..=2.0).contains(&row[7].parse::<f64>().unwrap()), "{row:?}");
            assert!((0.0..=0.5).contains(&row[9].parse::<f64>().unwrap()), "{row:?}");
            // One run has no standard error.
            assert_eq!((row[4].as_str(), row[8].as_str(), row[10].as_str()), ("1", "", ""));
        }
    }
    let figure = scratch.read("out/sim1.svg");
    assert!(figure.starts_with("<svg") && figure.contains("figure 9 of the paper"), "{figure}");
    let summary = scratch.read("out/summary.md");
    assert!(summary.contains("\n| sim1 | 100 | 0."), "{summary}");
    assert!(!summary.contains("\n| sim1 | 300 | "), "no maps were made there: {summary}");
}

#[test]
fn exploration_is_shown_run_by_run() {
    let scratch = reproduced(&["sim4"]);
    let table = rows(&scratch, "out/sim4.csv");
    assert_eq!(
        table[0].join(","),
        "experiment,layout,walk,steps,method,landmarks,spread,entropy,delaunay_error,orientation_error"
    );
    assert_eq!(table.len(), 1 + 50 * 2);
    for row in &table[1..] {
        // Steps are 0.1 m long, and ten objects seen evenly have the entropy ln 10 = 2.303.
        let [spread, entropy] = [6, 7].map(|column: usize| row[column].parse::<f64>().unwrap());
        assert!((0.02..=0.1001).contains(&spread) && (1.0..2.303).contains(&entropy), "{row:?}");
    }
    // Two clouds of 50 in each of four panels, and two keys.
    assert_eq!(scratch.read("out/sim4.svg").matches("<circle").count(), 4 * 2 * 50 + 2);
    assert!(scratch.read("out/summary.md").contains("| sim4 | correlation of Errdel and Ent | -0.720 | "));
}

#[test]
fn the_robots_trial_is_mapped_by_both_methods() {
    let scratch = reproduced(&["exp"]);
    let table = rows(&scratch, "out/exp.csv");
    assert_eq!(table[0].join(","), "experiment,method,landmark,sightings,x,y");
    for method in ["classical", "auto"] {
        assert_eq!(table.iter().filter(|row| row[1] == method).count(), 6);
        assert!(scratch.read(&format!("out/exp-{method}.svg")).contains(method));
    }
    assert!(scratch.read("out/summary.md").contains("\n| 2 | 9 | "), "landmark 2 is in nine of ten lists");
}

#[test]
fn results_depend_on_the_seed_and_not_on_the_threads() {
    let scratch = reproduced(&["sim5b", "sim6"]);
    for (folder, option) in [("same", "--threads=1"), ("other", "--seed=1")] {
        scratch.succeeds(&[&["reproduce", "sim6", "sim5b", option], &SMALL[..], &[folder]].concat());
    }
    for file in ["sim5b.csv", "sim5b.svg", "sim6.csv", "sim6.svg", "summary.md"] {
        assert_eq!(scratch.read(&format!("same/{file}")), scratch.read(&format!("out/{file}")), "{file}");
        assert_ne!(scratch.read(&format!("other/{file}")), scratch.read(&format!("out/{file}")), "{file}");
    }
}

#[test]
fn what_cannot_be_reproduced_is_refused() {
    let scratch = Scratch::new();
    scratch.refuses(&["reproduce", "sim8", "-o", "out"], 2, "[possible values: sim1, sim2a,");
    scratch.refuses(&["reproduce", "-o", "out"], 2, "<EXPERIMENT>");
    scratch.refuses(&["reproduce", "sim1"], 2, "--output <DIR>");
    scratch.refuses(&["reproduce", "sim1", "--layouts=0", "-o", "out"], 2, "1..=10000");
    scratch.file("file", "");
    scratch.refuses(&["reproduce", "exp", "-o", "file"], 1, "a file stands where a folder is wanted");
}
