//! Which stage may know which: the sources are read and held against one table.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use crate::rust_words::{tokens, without_tests};

/// A module and what it may import of ours; `main` with its `commands` and `python`, a package of its
/// own, are users of the public API.
const MAY_IMPORT: [(&str, &[&str]); 26] = [
    ("error", &[]),
    ("random", &[]),
    ("stage", &[]),
    ("processor", &[]),
    ("closed_forms", &["error"]),
    ("body", &["error"]),
    ("mesh_file", &["body", "error"]),
    ("contact", &["body", "mesh_file", "error"]),
    ("problem", &["processor", "error"]),
    (
        "condensation",
        &["body", "contact", "problem", "error", "stage", "processor"],
    ),
    ("cone", &["problem", "limit", "error"]),
    ("limit", &["problem", "error"]),
    ("half_space", &["problem", "error"]),
    (
        "kkt",
        &[
            "body",
            "contact",
            "problem",
            "condensation",
            "error",
            "processor",
        ],
    ),
    (
        "alternation",
        &[
            "problem",
            "cone",
            "limit",
            "kkt",
            "error",
            "stage",
            "processor",
        ],
    ),
    (
        "trust",
        &["problem", "alternation", "kkt", "random", "error"],
    ),
    (
        "report",
        &[
            "body",
            "mesh_file",
            "contact",
            "problem",
            "condensation",
            "alternation",
            "half_space",
            "kkt",
            "trust",
            "error",
        ],
    ),
    (
        "scene",
        &[
            "body",
            "mesh_file",
            "contact",
            "problem",
            "condensation",
            "alternation",
            "half_space",
            "error",
        ],
    ),
    ("deck", &["body", "mesh_file", "scene", "error"]),
    ("validity", &["body", "contact", "kkt", "report"]),
    (
        "pipeline",
        &[
            "validity",
            "body",
            "contact",
            "problem",
            "condensation",
            "cone",
            "limit",
            "alternation",
            "kkt",
            "trust",
            "report",
            "scene",
            "half_space",
            "error",
            "stage",
        ],
    ),
    (
        "verify",
        &[
            "body",
            "closed_forms",
            "contact",
            "problem",
            "condensation",
            "alternation",
            "kkt",
            "pipeline",
            "report",
            "random",
            "scene",
            "error",
        ],
    ),
    (
        "study",
        &[
            "body",
            "contact",
            "problem",
            "condensation",
            "cone",
            "alternation",
            "kkt",
            "pipeline",
            "report",
            "scene",
            "half_space",
            "error",
        ],
    ),
    ("main", &[]),
    ("commands", &[]),
    ("python", &[]),
];

/// Of what it imports, a module may name only these; its unit tests may name more.
const ONLY: [(&str, &str, &[&str]); 3] = [
    (
        "cone",
        "problem",
        &["ContactProblem", "Floating", "velocity_basis"],
    ),
    ("cone", "limit", &[]),
    ("scene", "alternation", &["Interrupt", "Settings"]),
];

/// What only unit tests may import: a shipped file of the first may not name the second.
const TESTS_ONLY: [(&str, &str); 1] = [("contact", "mesh_file")];

/// Words and the only places (folders or files below `src`) that may say them; unit tests are free.
const WORDS: [(&[&str], &[&str]); 6] = [
    (
        &["fs", "File", "OpenOptions"],
        &["scene", "report", "commands", "python"],
    ),
    (
        &[
            "serde",
            "serde_json",
            "serde_path_to_error",
            "schemars",
            "Serialize",
            "Deserialize",
            "JsonSchema",
        ],
        &["scene", "report"],
    ),
    (
        &[
            "println", "eprintln", "print", "eprint", "dbg", "stdout", "stderr",
        ],
        &["main", "commands"],
    ),
    (&["metis_sys"], &["condensation/ordering"]),
    (
        &["unsafe", "unsafe_code"],
        &["condensation/ordering", "condensation/mumps/face"],
    ),
    (&["extern"], &["condensation/mumps/face"]),
];

/// Names that say nothing about mechanics.
const NO_NAMES: [&str; 9] = [
    "utils", "util", "helpers", "common", "types", "manager", "data", "info", "misc",
];

/// One file below `src`, as words and signs; `name` is its path without ending, or its folder's.
struct Source {
    name: String,
    tokens: Vec<String>,
}

impl Source {
    fn new(name: &str, text: &str) -> Self {
        Self {
            name: name.to_owned(),
            tokens: tokens(text),
        }
    }

    /// The folder or file directly below `src`.
    fn module(&self) -> &str {
        self.name.split('/').next().unwrap()
    }

    /// What is compiled into the library: nothing of a folder of tests.
    fn shipped(&self) -> Vec<String> {
        match self.name.split('/').any(|part| part == "tests") {
            true => Vec::new(),
            false => without_tests(&self.tokens),
        }
    }

    /// What breaks the table, in words.
    fn violations(&self) -> Vec<String> {
        let mut found = Vec::new();
        let (module, shipped) = (self.module(), self.shipped());
        let root = module == "lib";
        for path in imports(&self.tokens) {
            let known = MAY_IMPORT.iter().find(|row| row.0 == module);
            let allowed = known.is_some_and(|row| row.1.contains(&path[0].as_str()));
            if !root && !allowed && path[0] != module {
                found.push(format!("{} imports {}", self.name, path.join("::")));
            }
        }
        for path in imports(&shipped) {
            let only = ONLY
                .iter()
                .find(|rule| (rule.0, rule.1) == (module, &path[0]));
            let tests_only = TESTS_ONLY.contains(&(module, path[0].as_str()));
            if tests_only
                || only.is_some_and(|rule| path.len() < 2 || !rule.2.contains(&path[1].as_str()))
            {
                found.push(format!("{} imports {}", self.name, path.join("::")));
            }
        }
        if longest_climb(&shipped) >= self.name.split('/').count() {
            found.push(format!("{} reaches the crate's root by super", self.name));
        }
        for (words, places) in WORDS {
            let here = |place: &str| self.name == place || module == place;
            if !places.iter().any(|place| here(place)) {
                let said = shipped
                    .iter()
                    .filter(|token| words.contains(&token.as_str()));
                found.extend(said.map(|word| format!("{} says {word}", self.name)));
            }
        }
        if self.name != "cone/clarabel" && names_clarabel(&shipped) {
            found.push(format!("{} names Clarabel", self.name));
        }
        let named = declared_modules(&self.tokens).chain(self.name.split('/').map(str::to_owned));
        let vague = named.filter(|name| NO_NAMES.contains(&name.as_str()));
        found.extend(vague.map(|name| format!("{}: a module named {name}", self.name)));
        found
    }
}

/// Every path behind `crate::`, braces multiplied out.
fn imports(tokens: &[String]) -> Vec<Vec<String>> {
    let starts = (0..tokens.len())
        .filter(|&at| tokens[at] == "crate" && tokens.get(at + 1).is_some_and(|next| next == "::"));
    starts.flat_map(|at| expand(tokens, at + 2).0).collect()
}

/// The paths of a use tree that starts at a token, and the token after it.
fn expand(tokens: &[String], start: usize) -> (Vec<Vec<String>>, usize) {
    let is = |at: usize, sign: &str| tokens.get(at).is_some_and(|token| token == sign);
    if !is(start, "{") {
        let own = tokens.get(start).cloned().unwrap_or_default();
        if !is(start + 1, "::") {
            return (vec![vec![own]], start + 1);
        }
        let (mut paths, end) = expand(tokens, start + 2);
        paths
            .iter_mut()
            .for_each(|path| path.insert(0, own.clone()));
        return (paths, end);
    }
    let (mut paths, mut at) = (Vec::new(), start + 1);
    while at < tokens.len() && !is(at, "}") {
        let (inner, end) = expand(tokens, at);
        paths.extend(inner);
        at = end + usize::from(is(end, ","));
    }
    (paths, at + 1)
}

/// Every path of ours that a shipped file names, from the crate's root: `super` is followed up.
fn absolute_paths(source: &Source) -> Vec<Vec<String>> {
    let tokens = source.shipped();
    let is = |at: usize, sign: &str| tokens.get(at).is_some_and(|token| token == sign);
    let parts: Vec<String> = source.name.split('/').map(str::to_owned).collect();
    let mut found = imports(&tokens);
    let mut at = 0;
    while at < tokens.len() {
        let mut climb = 0;
        while is(at, "super") && is(at + 1, "::") {
            (climb, at) = (climb + 1, at + 2);
        }
        if climb > 0 && climb <= parts.len() {
            let (paths, _) = expand(&tokens, at);
            let base = &parts[..parts.len() - climb];
            found.extend(paths.into_iter().map(|path| [base, &path].concat()));
        }
        at += 1;
    }
    found
}

/// Where the names that a folder re-exports are defined: `pub use file::{Name}`.
fn exports(facade: &Source) -> BTreeMap<String, String> {
    let (tokens, mut found) = (&facade.tokens, BTreeMap::new());
    for at in 0..tokens.len() {
        if tokens[at] == "use" && tokens.get(at + 1).is_some_and(|word| word != "crate") {
            for path in expand(tokens, at + 1)
                .0
                .into_iter()
                .filter(|path| path.len() > 1)
            {
                found.insert(path[path.len() - 1].clone(), path[0].clone());
            }
        }
    }
    found
}

/// Files and folders that stand directly in `folder`, with what each uses of the others.
fn room(sources: &[Source], folder: &str) -> BTreeMap<String, BTreeSet<String>> {
    let facade = sources.iter().find(|source| source.name == folder);
    let exported = facade.map(exports).unwrap_or_default();
    let folder: Vec<&str> = folder.split('/').collect();
    let below = |path: &[String]| {
        let inside = path.len() > folder.len() && folder.iter().zip(path).all(|(a, b)| a == b);
        inside.then(|| path[folder.len()].clone())
    };
    let mut arrows = BTreeMap::<String, BTreeSet<String>>::new();
    for source in sources {
        let parts: Vec<String> = source.name.split('/').map(str::to_owned).collect();
        let Some(own) = below(&parts) else { continue };
        let named = absolute_paths(source)
            .into_iter()
            .filter_map(|path| below(&path));
        let files = named.map(|word| exported.get(&word).cloned().unwrap_or(word));
        let uses: BTreeSet<String> = files.filter(|file| *file != own).collect();
        arrows.entry(own).or_default().extend(uses);
    }
    arrows
}

/// A circle of arrows, if there is one: files are taken away whose arrows all lead to files taken.
fn circle(mut arrows: BTreeMap<String, BTreeSet<String>>) -> BTreeSet<String> {
    loop {
        let free = |uses: &BTreeSet<String>| !uses.iter().any(|file| arrows.contains_key(file));
        let done: Vec<String> = arrows
            .iter()
            .filter(|(_, uses)| free(uses))
            .map(|(file, _)| file.clone())
            .collect();
        if done.is_empty() {
            return arrows.into_keys().collect();
        }
        done.iter().for_each(|file| drop(arrows.remove(file)));
    }
}

/// Most `super` in one path.
fn longest_climb(tokens: &[String]) -> usize {
    let mut longest = 0;
    for at in 0..tokens.len() {
        let path = tokens[at..].chunks(2);
        longest = longest.max(path.take_while(|step| *step == ["super", "::"]).count());
    }
    longest
}

/// The crate, and not our file of the same name.
fn names_clarabel(tokens: &[String]) -> bool {
    (0..tokens.len()).any(|at| {
        let before: Vec<&str> = tokens[..at]
            .iter()
            .rev()
            .take(2)
            .map(String::as_str)
            .collect();
        let ours = matches!(before[..], ["mod", ..] | ["::", "super" | "self" | "cone"]);
        tokens[at] == "clarabel" && !ours
    })
}

fn declared_modules(tokens: &[String]) -> impl Iterator<Item = String> {
    let pairs = tokens.windows(2).filter(|pair| pair[0] == "mod");
    pairs.map(|pair| pair[1].clone())
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn sources() -> Vec<Source> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let source = |path: PathBuf| {
        let name = path.strip_prefix(&root).unwrap().with_extension("");
        let name = name.to_str().unwrap().replace('\\', "/");
        let name = name.strip_suffix("/mod").unwrap_or(&name);
        Source::new(name, &fs::read_to_string(path).unwrap())
    };
    files(&root).into_iter().map(source).collect()
}

#[test]
fn every_stage_imports_only_what_the_table_allows() {
    let found: Vec<String> = sources().iter().flat_map(Source::violations).collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn every_module_has_its_row_and_the_pipeline_uses_its_stages() {
    let sources = sources();
    let found: BTreeSet<&str> = sources.iter().map(Source::module).collect();
    let expected: BTreeSet<&str> = MAY_IMPORT.iter().map(|row| row.0).chain(["lib"]).collect();
    assert_eq!(found, expected);
    // The reader of imports does see them: these stages cannot do without each other.
    for (module, stage) in [
        ("alternation", "cone"),
        ("kkt", "body"),
        ("pipeline", "scene"),
    ] {
        let of_module = sources.iter().filter(|source| source.module() == module);
        let mut paths = of_module.flat_map(|source| imports(&source.tokens));
        assert!(
            paths.any(|path| path[0] == stage),
            "{module} without {stage}"
        );
    }
}

#[test]
fn no_circle_stands_inside_a_folder() {
    let sources = sources();
    let mut folders: BTreeSet<&str> = BTreeSet::new();
    for source in &sources {
        folders.extend(
            source
                .name
                .match_indices('/')
                .map(|(at, _)| &source.name[..at]),
        );
    }
    let circles = folders.into_iter().filter_map(|folder| {
        let found = circle(room(&sources, folder));
        (!found.is_empty()).then(|| format!("{folder}: {found:?}"))
    });
    let circles: Vec<String> = circles.collect();
    assert!(circles.is_empty(), "\n{}", circles.join("\n"));
}

#[test]
fn a_circle_is_found_through_a_folder_s_exports() {
    let files = [
        ("kkt", "mod a; mod b; pub use a::Alpha;"),
        ("kkt/a", "use super::b::Beta;"),
        (
            "kkt/b",
            "use crate::kkt::Alpha; #[cfg(test)] mod tests { use super::a; }",
        ),
        ("kkt/c", "use super::a::Alpha;"),
    ];
    let sources = files.map(|(name, text)| Source::new(name, text));
    let found = circle(room(&sources, "kkt"));
    // c uses the circle and is no part of it, but is left over with it.
    assert_eq!(found, ["a", "b", "c"].map(str::to_owned).into());
    assert!(circle(room(&sources[..2], "kkt")).is_empty());
}

#[test]
fn the_biggest_folder_holds_at_most_16_percent() {
    let sources = sources();
    let mut words = BTreeMap::<&str, usize>::new();
    for source in &sources {
        *words.entry(source.module()).or_default() += source.shipped().len();
    }
    let all: usize = words.values().sum();
    let (folder, biggest) = words.iter().max_by_key(|row| row.1).unwrap();
    assert!(
        biggest * 100 <= 16 * all,
        "{folder} holds {biggest} of {all} words and signs"
    );
}

#[test]
fn a_forbidden_word_or_import_is_found_wherever_it_hides() {
    let count = |name: &str, text: &str| Source::new(name, text).violations().len();
    assert_eq!(
        count(
            "kkt/judge",
            "use crate::{body::Mesh, cone::{Role, NormalHalfStep}};"
        ),
        2
    );
    assert_eq!(
        count("kkt/judge", "fn f() { crate::alternation::solve(); }"),
        1
    );
    assert_eq!(count("kkt", "use super::cone;"), 1);
    assert_eq!(count("kkt/vtu/x", "use super::super::super::cone;"), 1);
    assert_eq!(
        count(
            "cone/normal",
            "use crate::problem::{ContactProblem, Operator};"
        ),
        1
    );
    assert_eq!(count("cone/normal", "use ::clarabel::solver;"), 1);
    assert_eq!(count("cone/normal", "use super::clarabel::ConeProgram;"), 0);
    assert_eq!(
        count(
            "alternation/run",
            "let c = '\"'; println!(\"{}\", r#\"x\"#); let s = std::fs::read;"
        ),
        2
    );
    assert_eq!(count("body/mesh", "use crate::Error; mod utils { }"), 2);
    assert_eq!(count("body/mesh", "unsafe { }"), 1);
}

#[test]
fn comments_strings_lifetimes_and_unit_tests_are_free() {
    let text = r##"
        //! println! crate::cone
        /* unsafe */ use super::material; // std::fs
        fn f<'a>(x: &'a str) -> &'a str { "println! \" crate::cone unsafe" }
        const RAW: &str = r#"crate::cone " unsafe"#;
        #[cfg(test)]
        mod tests { fn g() { println!("{}", std::fs::read_to_string("x")); } }
    "##;
    assert_eq!(
        Source::new("body/mesh", text).violations(),
        Vec::<String>::new()
    );
}
