//! What the README says must be so.

use std::fs;
use std::path::Path;

use crate::scratch::{Scratch, data};

fn readme() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../README.md")).unwrap()
}

/// Cells of the first column of the table under a heading.
fn first_column(heading: &str) -> Vec<String> {
    let text = readme();
    let section = text.split("\n## ").find(|section| section.starts_with(heading)).unwrap();
    let rows = section.lines().filter_map(|line| line.strip_prefix("| "));
    rows.skip(1).map(|row| row.split(" |").next().unwrap().trim_matches('`').to_owned()).collect()
}

/// Runs the commands of the tour in their order; the log lies where the README says.
fn take_the_tour(scratch: &Scratch) -> usize {
    let folder = data("");
    let text = readme();
    let blocks = text.split("```sh\n").skip(1).filter_map(|rest| rest.split("```").next());
    let commands: Vec<_> = blocks
        .flat_map(str::lines)
        .filter_map(|line| line.strip_prefix("covimap "))
        .map(|line| line.replace("crates/covimap-cli/data/", folder.to_str().unwrap()))
        .collect();
    for command in &commands {
        scratch.succeeds(&command.split(' ').collect::<Vec<_>>());
    }
    commands.len()
}

#[test]
fn the_tour_can_be_taken_and_its_numbers_are_right() {
    let scratch = Scratch::new();
    assert_eq!(take_the_tour(&scratch), 15);
    let truth = data("mrclam-1.truth.csv");
    let errors = |map: &str| {
        let found = scratch.succeeds(&["evaluate", map, truth.to_str().unwrap(), "--json"]).json();
        ["orientation_error", "delaunay_error", "rmse"].map(|key| found[key].as_f64().unwrap())
    };
    let [triangles, edges, off] = errors("mrclam-1.map.json");
    assert!(triangles < 0.06, "about one triangle in twenty: {triangles}");
    assert!(edges < 0.11, "at most one edge in ten: {edges}");
    assert!(off < 1.0, "less than a metre: {off}");
    let [triangles, edges, off] = errors("classical.map.json");
    let classical = format!(
        "has {:.0} of 100 triangles and {:.0} of 100 edges wrong, and is {off:.1} m off",
        100.0 * triangles,
        100.0 * edges
    );
    let text = readme().split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains(&classical), "the README does not say: {classical}");
}

#[test]
fn every_command_is_in_the_table() {
    let help = Scratch::new().succeeds(&["--help"]).stdout;
    let commands = help.split("Commands:\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let mut offered: Vec<_> = commands.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
    offered.retain(|&command| command != "help");
    let table = first_column("Commands");
    let listed: Vec<_> = table.iter().map(|command| command.split(' ').nth(1).unwrap()).collect();
    assert_eq!(listed, offered);
}

#[test]
fn the_exit_codes_are_those_of_the_help() {
    let help = Scratch::new().succeeds(&["--help"]).stdout;
    let codes = help.split("Exit codes: ").nth(1).unwrap();
    let said: Vec<_> = codes.split(", ").map(|code| code.split(' ').next().unwrap()).collect();
    assert_eq!(first_column("Exit codes"), said);
}
