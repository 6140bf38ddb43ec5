//! The page of the solver's constants holds every one of them, with the value that the sources have.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Folders whose constants decide how a problem is solved or judged.
const FOLDERS: [&str; 9] = [
    "contact",
    "problem",
    "condensation",
    "cone",
    "limit",
    "half_space",
    "kkt",
    "alternation",
    "trust",
];

/// File, name and value of the constants of a file that are numbers.
fn of_source(file: &str, text: &str) -> Vec<[String; 3]> {
    let shipped = text.split("#[cfg(test)]\nmod tests").next().unwrap();
    let statements = shipped.split("const ").skip(1);
    let found = statements.filter_map(|rest| {
        let (name, rest) = rest.split_once(": ")?;
        let upper = |c: char| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '_';
        if name.is_empty() || !name.chars().all(upper) {
            return None;
        }
        let statement = rest.split(";\n").next()?;
        let (_, value) = statement.split_once('=')?;
        let value = value.split_whitespace().collect::<Vec<_>>().join(" ");
        let number = value.contains(|c: char| c.is_ascii_digit()) && !value.contains("Self");
        number.then(|| [file.to_owned(), name.to_owned(), value])
    });
    found.collect()
}

/// File, name and value of the rows of the page.
fn of_page(text: &str) -> Vec<[String; 3]> {
    let mut folder = String::new();
    let mut found = Vec::new();
    for line in text.lines() {
        if let Some(heading) = line.strip_prefix("## `") {
            heading.split('`').next().unwrap().clone_into(&mut folder);
        }
        let cells: Vec<&str> = line.split('`').collect();
        if let ["| ", file, " | ", name, " | ", value, ..] = cells[..] {
            found.push([
                format!("{folder}/{file}"),
                name.to_owned(),
                value.to_owned(),
            ]);
        }
    }
    found
}

fn below(folder: &Path, into: &mut Vec<std::path::PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() && !path.ends_with("tests") {
            below(&path, into);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            into.push(path);
        }
    }
}

#[test]
fn every_constant_of_the_solver_stands_on_the_page_with_its_value() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut files = Vec::new();
    for folder in FOLDERS {
        below(&source.join(folder), &mut files);
    }
    let coded = files.iter().flat_map(|path| {
        let name = path.strip_prefix(&source).unwrap().to_str().unwrap();
        of_source(&name.replace('\\', "/"), &fs::read_to_string(path).unwrap())
    });
    let coded: BTreeSet<[String; 3]> = coded.collect();
    let page = fs::read_to_string(source.join("constants.md")).unwrap();
    let stated: BTreeSet<[String; 3]> = of_page(&page).into_iter().collect();
    let missing: Vec<_> = coded.difference(&stated).collect();
    let outdated: Vec<_> = stated.difference(&coded).collect();
    assert!(
        missing.is_empty() && outdated.is_empty(),
        "not on the page: {missing:#?}\nno longer so: {outdated:#?}"
    );
    assert!(coded.len() > 80, "{}", coded.len());
}

#[test]
fn the_reader_of_constants_sees_every_form() {
    let text = "/// Why.\nconst A: f64 = 1e-2;\n    pub(super) const B_2: (f64, f64) =\n        (1e-10, 1e-7);\n\
                const fn f() {}\nconst NONE: usize = usize::MAX;\n#[cfg(test)]\nmod tests { const C: f64 = 1.0; }";
    let found = of_source("x.rs", text);
    let expected = [["x.rs", "A", "1e-2"], ["x.rs", "B_2", "(1e-10, 1e-7)"]];
    assert_eq!(found, expected.map(|row| row.map(str::to_owned)));
    let rows = of_page("## `kkt` judge\n| `a.rs` | `A` | `1e-2` | why |");
    assert_eq!(rows, [["kkt/a.rs", "A", "1e-2"].map(str::to_owned)]);
}
