//! What the pages for readers point to is there: files, programs, and one front page that can be finished.

use std::fs;
use std::path::{Path, PathBuf};

/// The pages, below the crate's folder.
const PAGES: [&str; 8] = [
    "README.md",
    "benches/README.md",
    "examples/README.md",
    "tests/README.md",
    "tests/data/README.md",
    "src/method.md",
    "src/constants.md",
    "src/python/README.md",
];

/// Most lines of the front page.
const MOST_LINES: usize = 250;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn page(name: &str) -> String {
    fs::read_to_string(root().join(name)).unwrap()
}

/// Targets of the links of a page, without those into the web and into the documentation.
fn links(text: &str) -> Vec<&str> {
    let parts = text.split("](").skip(1);
    let targets = parts.filter_map(|rest| rest.split(')').next());
    let targets = targets.filter(|target| !target.contains("://") && !target.contains("::"));
    targets
        .map(|target| target.split('#').next().unwrap())
        .collect()
}

/// Words in code that look like files of the crate.
fn named_files(text: &str) -> Vec<&str> {
    let words = text.split(|c: char| c.is_whitespace() || "`()|,;".contains(c));
    let file = |word: &&str| {
        // What a loop of the shell fills in is none yet.
        if word.contains('$') {
            return false;
        }
        let folder = ["src/", "tests/", "examples/", "benches/"];
        folder.iter().any(|folder| word.starts_with(folder))
            && [".rs", ".json", ".md", ".svg"]
                .iter()
                .any(|ending| word.ends_with(ending))
    };
    words.filter(file).collect()
}

/// Programs that commands of a page call, as files.
fn named_programs(text: &str) -> Vec<[PathBuf; 2]> {
    let mut found = Vec::new();
    for (option, folder) in [
        ("--test", "tests"),
        ("--bench", "benches"),
        ("--example", "examples"),
    ] {
        let option = format!("{option} ");
        let rest = text.split(option.as_str()).skip(1);
        let names = rest.filter_map(|rest| {
            rest.split(|c: char| !c.is_alphanumeric() && c != '_')
                .next()
        });
        let names = names.filter(|name| !name.is_empty() && name.to_lowercase() == **name);
        found.extend(names.map(|name| {
            [
                root().join(folder).join(name).join("main.rs"),
                root().join(folder).join(format!("{name}.rs")),
            ]
        }));
    }
    found
}

#[test]
fn every_link_of_every_page_leads_to_a_file() {
    let mut missing = Vec::new();
    for name in PAGES {
        let text = page(name);
        let folder = root().join(name);
        let folder = folder.parent().unwrap();
        let linked = links(&text).into_iter().map(|target| folder.join(target));
        let named = named_files(&text).into_iter().map(|file| root().join(file));
        let broken = linked.chain(named).filter(|path| !path.exists());
        missing.extend(broken.map(|path| format!("{name}: {}", path.display())));
        let programs = named_programs(&text).into_iter();
        let broken = programs.filter(|paths| paths.iter().all(|path| !path.exists()));
        missing.extend(broken.map(|[path, _]| format!("{name}: {}", path.display())));
    }
    assert!(missing.is_empty(), "\n{}", missing.join("\n"));
}

#[test]
fn the_checks_of_this_file_see_what_is_broken() {
    assert_eq!(links("[a](b.md#c) [d](https://e) [f](crate::g)"), ["b.md"]);
    assert_eq!(
        named_files("see `src/lib.rs`, (`tests/x.md`)"),
        ["src/lib.rs", "tests/x.md"]
    );
    let programs = named_programs("cargo test --test house, cargo bench --bench NAME");
    assert_eq!(programs.len(), 1);
    assert!(programs[0][0].exists());
}

#[test]
fn the_front_page_can_be_finished() {
    let lines = page("README.md").lines().count();
    assert!(lines <= MOST_LINES, "{lines} lines");
}

/// Rows of a table that is measured stand in one place only.
#[test]
fn no_measured_row_stands_on_two_pages() {
    let mut seen: Vec<(String, &str)> = Vec::new();
    for name in PAGES {
        for row in page(name).lines().filter(|line| line.starts_with("| ")) {
            let numbers = row.chars().filter(char::is_ascii_digit).count();
            let twice = seen.iter().find(|(other, _)| other == row);
            assert!(
                numbers < 4 || twice.is_none(),
                "{name} and {twice:?}: {row}"
            );
            seen.push((row.to_owned(), name));
        }
    }
}
