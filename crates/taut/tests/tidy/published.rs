//! What every published package says of itself and brings along.

use std::collections::BTreeSet;
use std::fs;

use serde_json::Value;

use super::{metadata, read, root};

/// The packages that go to a registry.
fn published() -> Vec<Value> {
    let packages = metadata()["packages"].as_array().expect("a list").clone();
    packages.into_iter().filter(|package| package["publish"].is_null()).collect()
}

fn name(package: &Value) -> &str {
    package["name"].as_str().expect("packages have names")
}

#[test]
fn packages_bring_their_readme_and_both_licenses() {
    needs_repository!();
    let packages = published();
    assert!(packages.len() >= 15, "{} packages are published", packages.len());
    for package in &packages {
        let folder = root().join("crates").join(name(package));
        for license in ["LICENSE-MIT", "LICENSE-APACHE"] {
            let own = fs::read(folder.join(license)).unwrap_or_default();
            assert!(own == fs::read(root().join(license)).expect("read"), "{}", name(package));
        }
        let page = read(&folder.join("README.md"));
        assert!(page.starts_with(&format!("# {}\n", name(package))), "{}", name(package));
        for field in ["repository", "homepage", "documentation", "description", "license"] {
            assert!(package[field].is_string(), "{} has no {field}", name(package));
        }
        let count = |field: &str| package[field].as_array().expect("a list").len();
        assert!((1..=5).contains(&count("keywords")), "{}", name(package));
        assert!((1..=5).contains(&count("categories")), "{}", name(package));
    }
    for license in ["LICENSE-MIT", "LICENSE-APACHE"] {
        assert_eq!(read(&root().join("python").join(license)), read(&root().join(license)));
    }
}

/// A registry takes a package after all that it names, what its tests use included.
#[test]
fn packages_can_be_published_one_after_the_other() {
    needs_repository!();
    let packages = published();
    let ours: BTreeSet<&str> = packages.iter().map(name).collect();
    let mut done = BTreeSet::new();
    while done.len() < packages.len() {
        let next = packages.iter().find(|package| {
            let needs = package["dependencies"].as_array().expect("a list").iter().map(name);
            !done.contains(name(package))
                && needs.filter(|need| ours.contains(need)).all(|need| done.contains(need))
        });
        let rest: Vec<_> = ours.difference(&done).collect();
        done.insert(name(next.unwrap_or_else(|| panic!("{rest:?} need each other"))));
    }
    for dependency in packages.iter().flat_map(|p| p["dependencies"].as_array().expect("a list")) {
        let is_bare = dependency["path"].is_string() && dependency["req"] == "*";
        assert!(!is_bare, "{} has no version", name(dependency));
    }
}

#[test]
fn version_and_addresses_are_the_same_everywhere() {
    needs_repository!();
    let packages = published();
    let of = |field: &str| {
        let values: BTreeSet<_> = packages.iter().filter_map(|p| p[field].as_str()).collect();
        assert_eq!(values.len(), 1, "{values:?}");
        values.first().copied().unwrap_or_default().to_owned()
    };
    let (version, repository, homepage) = (of("version"), of("repository"), of("homepage"));
    let says = |file: &str, text: &str| {
        assert!(read(&root().join(file)).contains(text), "{file} does not say {text}");
    };
    says("CITATION.cff", &format!("\nversion: {version}\n"));
    says("CITATION.cff", &format!("repository-code: \"{repository}\""));
    for file in ["python/pyproject.toml", "SECURITY.md", "CITATION.cff", "docs/zensical.toml"] {
        says(file, &repository);
    }
    for file in ["python/pyproject.toml", "CITATION.cff", "docs/zensical.toml"] {
        says(file, &homepage);
    }
    says("packaging/homebrew/taut.rb", &homepage);
    for package in &packages {
        for dependency in package["dependencies"].as_array().expect("a list") {
            let is_ours = dependency["path"].is_string();
            assert!(!is_ours || dependency["req"] == format!("^{version}"), "{dependency}");
        }
    }
}
