//! A column of labels beside those of coordinates.

use taut_io::{Columns, Header, ReadOptions, open};

use super::{message, text_with, values};

fn labeled(label: &str) -> ReadOptions {
    ReadOptions { label: Some(label.to_owned()), ..Default::default() }
}

const FLOWERS: &str = "length,species,width\n1,setosa,2\n3,\"a, b\",4\n";

#[test]
fn labels_are_text_and_no_coordinates() {
    for (name, text) in [
        ("t.csv", FLOWERS.to_owned()),
        ("t.tsv", "length\tspecies\twidth\n1\tsetosa\t2\n3\ta, b\t4\n".to_owned()),
    ] {
        for label in ["species", "1"] {
            let input = text_with(name, &text, &labeled(label)).unwrap();
            assert_eq!(values(&input), [1.0, 2.0, 3.0, 4.0], "{name} {label}");
            assert_eq!(input.labels, ["setosa", "a, b"]);
            assert_eq!(input.columns, ["length", "width"]);
            assert_eq!(
                input.describe_cell(0, 1).to_string(),
                format!("{name}: row 1, column 2 (`width`)")
            );
        }
    }
    let options = ReadOptions {
        columns: Some("width,species,length".parse().unwrap()),
        ..labeled("species")
    };
    let input = text_with("t.csv", FLOWERS, &options).unwrap();
    assert_eq!((values(&input), input.labels.len()), (vec![2.0, 1.0, 4.0, 3.0], 2));
}

#[test]
fn a_first_row_of_numbers_and_a_label_is_a_point() {
    let input = text_with("t.csv", "1,2,x\n3,4,y\n", &labeled("2")).unwrap();
    assert_eq!(
        (values(&input), input.labels),
        (vec![1.0, 2.0, 3.0, 4.0], vec!["x".to_owned(), "y".to_owned()])
    );
    let input = text_with("t.csv", "1,2,7\n3,4,8\n", &labeled("2")).unwrap();
    assert_eq!(input.labels, ["7", "8"]);
    let input = text_with("t.csv", "a,b,c\n3,4,y\n", &labeled("2")).unwrap();
    assert_eq!((input.labels.len(), input.columns), (1, vec!["a".to_owned(), "b".to_owned()]));
    let absent = ReadOptions { header: Header::Absent, ..labeled("0") };
    assert_eq!(text_with("t.csv", "a,1\nb,2\n", &absent).unwrap().labels, ["a", "b"]);
}

#[test]
fn wrong_labels_are_named_with_their_place() {
    for (text, label, words) in [
        ("a,b\n1,2\n", "c", "there is no column `c`"),
        ("a,b\n1,2\n", "2", "there is no column 2"),
        (
            "a,b\n1,\n",
            "b",
            "row 1 (line 2), column 1 (`b`): the label is missing: fill it in, or remove that row",
        ),
        ("a,b\nx,y\n", "b", "`x` is not a number"),
        ("a,1O,c\n1,2,y\n", "2", "1O"),
        ("a,1,c\n1,2,y\n", "2", "`a`"),
        ("b\ny\n", "b", "columns `b`: expected columns beside that of the label"),
    ] {
        let said = message(text_with("t.csv", text, &labeled(label)));
        assert!(said.contains(words), "{label}: {said}");
    }
}

#[test]
fn numbers_of_other_formats_are_labels_too() {
    let points = taut_points::Points::new(&[0.0, 1.5, 2.0, 1.0, 2.5, 3.0f64], 3).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("t.npy");
    taut_io::write_points(&points, &[], &path, None, &taut_points::Monitor::silent()).unwrap();
    for (columns, expected) in
        [(None, vec![1.5, 2.0, 2.5, 3.0]), (Some("2,1"), vec![2.0, 1.5, 3.0, 2.5])]
    {
        let columns = columns.map(|columns: &str| columns.parse::<Columns>().unwrap());
        let options = ReadOptions { columns, ..labeled("0") };
        let input = open(&path, &options).unwrap();
        assert_eq!(
            (values(&input), input.labels),
            (expected, vec!["0".to_owned(), "1".to_owned()])
        );
    }
    let said = message(open(&path, &labeled("3")));
    assert!(said.contains("there is no column 3"), "{said}");
}

/// Text or whole numbers beside numbers, in the formats of columns.
#[cfg(feature = "arrow")]
#[test]
fn columns_of_text_are_labels() {
    use taut_io::{Column, Table, table_file};

    let towns = ["Ulm", "a, b", "Köln"].map(str::to_owned).to_vec();
    let table = Table::new()
        .with("x", Column::Real(vec![0.5, 1.5, 2.5]))
        .with("town", Column::Text(towns.clone()))
        .with("id", Column::Whole(vec![7, 8, 9]));
    let folder = tempfile::tempdir().unwrap();
    for name in ["t.parquet", "t.arrow"] {
        let path = folder.path().join(name);
        table_file(&table, &path).unwrap().commit().unwrap();
        for label in ["town", "1"] {
            let input = open(&path, &labeled(label)).unwrap();
            assert_eq!(values(&input), [0.5, 7.0, 1.5, 8.0, 2.5, 9.0], "{name}");
            assert_eq!(
                (input.labels, input.columns),
                (towns.clone(), vec!["x".into(), "id".into()])
            );
        }
        let columns = Some("id,x".parse::<Columns>().unwrap());
        let input = open(&path, &ReadOptions { columns, ..labeled("id") }).unwrap();
        assert_eq!(
            (values(&input), input.labels),
            (vec![0.5, 1.5, 2.5], vec!["7".into(), "8".into(), "9".into()])
        );
        let columns = Some("town".parse::<Columns>().unwrap());
        let said = message(open(&path, &ReadOptions { columns, ..labeled("town") }));
        assert!(said.contains("columns beside that of the label"), "{said}");
        assert!(message(open(&path, &labeled("none"))).contains("there is no column `none`"));
    }
    let gap = Table::new()
        .with("x", Column::Real(vec![1.0, 2.0]))
        .with("town", Column::Text(vec!["a".into(), String::new()]));
    let path = folder.path().join("gap.parquet");
    table_file(&gap, &path).unwrap().commit().unwrap();
    let said = message(open(&path, &labeled("town")));
    assert!(said.contains("row 2, column 1 (`town`): the label is missing"), "{said}");
}

#[test]
fn columns_are_selected_by_any_name() {
    let names = ["x, y", "1-2"].map(str::to_owned);
    let (columns, header) = (Some(Columns::of_names(names)), Header::Present);
    let options = ReadOptions { columns, header, ..Default::default() };
    let input = text_with("t.csv", "z,1-2,\"x, y\"\n1,2,3\n", &options).unwrap();
    assert_eq!(values(&input), [3.0, 2.0]);
}
