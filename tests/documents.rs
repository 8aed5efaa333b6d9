//! What the documents say must be so.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: impl AsRef<Path>) -> String {
    let path = root().join(path);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Modules of a crate: files and folders in `src`, but for the root.
fn modules_in(crate_name: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(root().join("crates").join(crate_name).join("src")).unwrap();
    entries
        .map(|entry| entry.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned())
        .filter(|name| name != "lib" && name != "main")
        .collect()
}

#[test]
fn the_architecture_names_every_module_and_no_other() {
    let text = read("docs/architecture.md");
    let section = text.split("\n## ").find(|section| section.starts_with("Modules")).unwrap();
    let crates = ["covimap-embed", "covimap-map", "covimap-plan", "covimap-sim", "covimap-cli"];
    let mut found = Vec::new();
    for row in section.lines().filter_map(|line| line.strip_prefix("| ")) {
        if let Some(name) = row.strip_prefix("**") {
            found.push((name.split("**").next().unwrap(), BTreeSet::new()));
        } else if let Some(name) = row.strip_prefix('`') {
            let module = name.split('`').next().unwrap().to_owned();
            assert!(found.last_mut().unwrap().1.insert(module.clone()), "{module} has two rows");
        }
    }
    assert_eq!(found.iter().map(|(name, _)| *name).collect::<Vec<_>>(), crates);
    for (name, rows) in found {
        let modules = modules_in(name);
        let missing: Vec<_> = modules.difference(&rows).collect();
        let gone: Vec<_> = rows.difference(&modules).collect();
        assert!(missing.is_empty() && gone.is_empty(), "{name}: without a row {missing:?}, no more {gone:?}");
    }
}

#[test]
fn every_kind_of_warning_is_explained() {
    let code = read("crates/covimap-map/src/report/warnings.rs");
    let kinds: BTreeSet<_> = code
        .split("warn(")
        .skip(1)
        .filter_map(|call| call.trim_start().strip_prefix('"')?.split('"').next())
        .collect();
    let text = read("docs/warnings.md");
    let explained: BTreeSet<_> =
        text.lines().filter_map(|line| line.strip_prefix("## `")?.strip_suffix('`')).collect();
    assert!(kinds.len() > 3, "the kinds are not found any more");
    assert_eq!(explained, kinds);
}

#[test]
fn the_test_command_of_the_readme_is_the_one_that_is_run() {
    let readme = read("README.md");
    let commands: Vec<_> = readme.lines().filter(|line| line.starts_with("cargo test ")).collect();
    assert_eq!(commands.len(), 1);
    assert!(read(".ci/run").lines().any(|line| line == format!("step {}", commands[0])));
}

#[test]
fn links_between_documents_lead_somewhere() {
    let docs = ["docs", "docs/maths", "docs/decisions"]
        .into_iter()
        .flat_map(|folder| fs::read_dir(root().join(folder)).unwrap())
        .map(|entry| entry.unwrap().path());
    let documents = docs
        .filter(|path| path.extension().is_some_and(|extension| extension == "md"))
        .chain(["README.md", "CHANGELOG.md", "crates/covimap-cli/data/README.md"].map(PathBuf::from));
    let mut links = 0;
    for document in documents {
        let text = read(&document);
        let targets = text.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
        for target in targets.filter(|target| !target.starts_with("http") && !target.starts_with('#')) {
            let file = target.split('#').next().unwrap();
            let path = root().join(&document).parent().unwrap().join(file);
            assert!(path.exists(), "{} names {target}", document.display());
            links += 1;
        }
    }
    assert!(links > 5, "links are not found any more");
}
