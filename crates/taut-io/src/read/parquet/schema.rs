//! The columns of a Parquet file as arrow names types: numbers, lists of numbers, texts and bytes are read, of the others the name is told.
//!
//! *Levels.* A value that may be missing, or lies in a list, comes with a definition level: how many of the steps from the root of its column that
//! can be missing are there.
//! *References.* Parquet format, "Logical Types" and "Nested Encoding"; of lists also "Backward-compatibility rules".

use std::collections::HashMap;
use std::sync::Arc;

use arrow_schema::{DataType, Field, IntervalUnit, Schema, TimeUnit};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use parquet::basic::{ConvertedType, LogicalType, Repetition, TimeUnit as Unit, Type as Physical};
use parquet::file::metadata::FileMetaData;
use parquet::schema::types::Type;

/// The key under which writers of arrow keep its schema.
const ARROW_SCHEMA: &str = "ARROW:schema";

/// A column as it is stored: its leaf among all leaves of the file, and the levels of its values.
#[derive(Clone, Copy)]
pub(super) struct Leaf {
    pub(super) number: usize,
    /// The level of a value that is there.
    pub(super) defined: i16,
    pub(super) list: Option<ListLevels>,
}

/// The levels of a column of lists.
#[derive(Clone, Copy)]
pub(super) struct ListLevels {
    /// From this level on a list is there, perhaps without an item.
    pub(super) present: i16,
    /// From this level on it has an item, perhaps without a value.
    pub(super) item: i16,
}

/// The schema of the file with its texts about itself, and for each column its leaf, if it is one that can be read.
pub(super) fn of(file: &FileMetaData) -> (Schema, Vec<Option<Leaf>>) {
    let texts = file.key_value_metadata().into_iter().flatten();
    let texts = texts.filter_map(|text| Some((text.key.clone(), text.value.clone()?)));
    let mut texts: HashMap<String, String> = texts.collect();
    let hints = hints(&texts);
    // Some writers keep the texts of a file only within the schema of arrow.
    for (key, text) in hints.iter().flat_map(|hints| &hints.metadata) {
        texts.entry(key.clone()).or_insert_with(|| text.clone());
    }
    let (mut fields, mut leaves, mut first) = (Vec::new(), Vec::new(), 0);
    let roots = file.schema_descr().root_schema().get_fields();
    let hints = hints.filter(|hints| hints.fields().len() == roots.len());
    for (i, root) in roots.iter().enumerate() {
        let (kind, leaf) = column(root, first);
        let leaf = leaf.filter(|leaf| {
            let stored = file.schema_descr().column(leaf.number);
            stored.max_def_level() == leaf.defined
                && stored.max_rep_level() == i16::from(leaf.list.is_some())
        });
        let hint = hints.as_ref().map(|hints| hints.field(i));
        let kind = match hint.filter(|hint| hint.name() == root.name()) {
            Some(hint) => hinted(kind, hint.data_type()),
            None => kind,
        };
        fields.push(Field::new(root.name(), kind, true));
        leaves.push(leaf);
        first += count(root);
    }
    (Schema::new_with_metadata(fields, texts), leaves)
}

/// The schema that a writer of arrow left beside that of Parquet.
fn hints(texts: &HashMap<String, String>) -> Option<Schema> {
    let bytes = BASE64_STANDARD.decode(texts.get(ARROW_SCHEMA)?).ok()?;
    let message = bytes.strip_prefix(&[0xff; 4]).and_then(|rest| rest.get(4..)).unwrap_or(&bytes);
    let message = arrow_ipc::root_as_message(message).ok()?;
    message.header_as_schema().map(arrow_ipc::convert::fb_to_schema)
}

/// The type of a column where the schema of arrow tells more than that of Parquet.
///
/// Parquet has no type for durations and for whole seconds, and arrow's numbers of a dictionary are names of classes: none of them are
/// coordinates.
fn hinted(kind: DataType, hint: &DataType) -> DataType {
    match (&kind, hint) {
        (
            DataType::Int32 | DataType::Int64,
            DataType::Timestamp(..)
            | DataType::Time32(_)
            | DataType::Time64(_)
            | DataType::Date32
            | DataType::Date64
            | DataType::Duration(_),
        ) => hint.clone(),
        (_, DataType::Dictionary(_, class)) if kind.is_integer() || kind.is_floating() => {
            match class.is_integer() || class.is_floating() {
                true => hint.clone(),
                false => hinted(kind, class),
            }
        }
        (DataType::Binary, DataType::Utf8 | DataType::LargeUtf8 | DataType::Utf8View) => {
            DataType::Utf8
        }
        (
            DataType::LargeList(item),
            DataType::List(hint) | DataType::LargeList(hint) | DataType::FixedSizeList(hint, _),
        ) => list_of(hinted(item.data_type().clone(), hint.data_type())),
        _ => kind,
    }
}

/// The leaves of a column.
fn count(node: &Type) -> usize {
    match node.is_primitive() {
        true => 1,
        false => node.get_fields().iter().map(|node| count(node)).sum(),
    }
}

/// The type of a column whose first leaf is `number`, and its leaf where it is a value or a list of values.
fn column(root: &Type, number: usize) -> (DataType, Option<Leaf>) {
    let optional = |node: &Type| i16::from(repetition(node) == Repetition::OPTIONAL);
    if repetition(root) == Repetition::REPEATED {
        let leaf = Leaf { number, defined: 1, list: Some(ListLevels { present: 0, item: 1 }) };
        return (list_of(once(root)), root.is_primitive().then_some(leaf));
    }
    if root.is_primitive() {
        return (primitive(root), Some(Leaf { number, defined: optional(root), list: None }));
    }
    let Some(item) = list_item(root) else { return (group(root), None) };
    let (present, defined) = match item {
        Item::Inner(item) => (optional(root), optional(root) + 1 + optional(item)),
        Item::Repeated(_) => (optional(root), optional(root) + 1),
    };
    let leaf = Leaf { number, defined, list: Some(ListLevels { present, item: present + 1 }) };
    (list_of(item.kind()), item.node().is_primitive().then_some(leaf))
}

fn repetition(node: &Type) -> Repetition {
    let info = node.get_basic_info();
    if info.has_repetition() { info.repetition() } else { Repetition::REQUIRED }
}

/// The item of a list.
#[derive(Clone, Copy)]
enum Item<'a> {
    /// The only child of the repeated group.
    Inner(&'a Type),
    /// The repeated node itself, as old writers left out the group between; no item is missing.
    Repeated(&'a Type),
}

impl<'a> Item<'a> {
    fn node(self) -> &'a Type {
        let (Item::Inner(node) | Item::Repeated(node)) = self;
        node
    }

    fn kind(self) -> DataType {
        match self {
            Item::Inner(node) => item_kind(node),
            Item::Repeated(node) => once(node),
        }
    }
}

/// The item of a group that is marked as a list.
fn list_item(group: &Type) -> Option<Item<'_>> {
    let info = group.get_basic_info();
    let is_list = matches!(info.logical_type_ref(), Some(LogicalType::List))
        || info.converted_type() == ConvertedType::LIST;
    let [repeated] = group.get_fields() else { return None };
    if !is_list || repetition(repeated) != Repetition::REPEATED {
        return None;
    }
    if repeated.is_primitive() {
        return Some(Item::Repeated(repeated));
    }
    let is_old = repeated.name() == "array" || repeated.name() == format!("{}_tuple", group.name());
    match repeated.get_fields() {
        [item] if !is_old => Some(Item::Inner(item)),
        _ => Some(Item::Repeated(repeated)),
    }
}

fn list_of(item: DataType) -> DataType {
    DataType::LargeList(Arc::new(Field::new("item", item, true)))
}

/// The type of a node with all its repetitions.
fn item_kind(node: &Type) -> DataType {
    if repetition(node) == Repetition::REPEATED { list_of(once(node)) } else { once(node) }
}

/// The type of one of the repetitions of a node.
fn once(node: &Type) -> DataType {
    if node.is_primitive() { primitive(node) } else { group(node) }
}

fn group(group: &Type) -> DataType {
    if let Some(item) = list_item(group) {
        return list_of(item.kind());
    }
    let fields = group.get_fields().iter();
    DataType::Struct(fields.map(|node| Field::new(node.name(), item_kind(node), true)).collect())
}

fn primitive(node: &Type) -> DataType {
    let Type::PrimitiveType { basic_info, physical_type, type_length, scale, precision } = node
    else {
        return DataType::Null;
    };
    let (logical, converted) = (basic_info.logical_type_ref(), basic_info.converted_type());
    let decimal = |precision: i32, scale: i32| {
        DataType::Decimal128(
            u8::try_from(precision).unwrap_or(u8::MAX),
            i8::try_from(scale).unwrap_or(i8::MAX),
        )
    };
    let kind = match (logical, converted) {
        (Some(LogicalType::Decimal(kind)), _) => Some(decimal(kind.precision, kind.scale)),
        (Some(LogicalType::Date), _) | (None, ConvertedType::DATE) => Some(DataType::Date32),
        (Some(LogicalType::Time(time)), _) => Some(time_of_day(time.unit)),
        (Some(LogicalType::Timestamp(time)), _) => {
            Some(timestamp(time.unit, time.is_adjusted_to_u_t_c))
        }
        (Some(LogicalType::Unknown), _) => Some(DataType::Null),
        (None, ConvertedType::DECIMAL) => Some(decimal(*precision, *scale)),
        (None, ConvertedType::TIME_MILLIS) => Some(time_of_day(Unit::MILLIS)),
        (None, ConvertedType::TIME_MICROS) => Some(time_of_day(Unit::MICROS)),
        (None, ConvertedType::TIMESTAMP_MILLIS) => Some(timestamp(Unit::MILLIS, true)),
        (None, ConvertedType::TIMESTAMP_MICROS) => Some(timestamp(Unit::MICROS, true)),
        (None, ConvertedType::INTERVAL) => Some(DataType::Interval(IntervalUnit::DayTime)),
        _ => None,
    };
    let is_unsigned = match logical {
        Some(LogicalType::Integer(kind)) => !kind.is_signed,
        _ => matches!(
            converted,
            ConvertedType::UINT_8
                | ConvertedType::UINT_16
                | ConvertedType::UINT_32
                | ConvertedType::UINT_64
        ),
    };
    let is_text =
        matches!(logical, Some(LogicalType::String | LogicalType::Json | LogicalType::Enum))
            || matches!(converted, ConvertedType::UTF8 | ConvertedType::JSON | ConvertedType::ENUM);
    kind.unwrap_or_else(|| match physical_type {
        Physical::BOOLEAN => DataType::Boolean,
        Physical::INT32 if is_unsigned => DataType::UInt32,
        Physical::INT32 => DataType::Int32,
        Physical::INT64 if is_unsigned => DataType::UInt64,
        Physical::INT64 => DataType::Int64,
        Physical::INT96 => timestamp(Unit::NANOS, false),
        Physical::FLOAT => DataType::Float32,
        Physical::DOUBLE => DataType::Float64,
        Physical::BYTE_ARRAY if is_text => DataType::Utf8,
        Physical::BYTE_ARRAY => DataType::Binary,
        Physical::FIXED_LEN_BYTE_ARRAY => match (logical, type_length) {
            (Some(LogicalType::Float16), 2) => DataType::Float16,
            _ => DataType::FixedSizeBinary(*type_length),
        },
    })
}

fn time_of_day(unit: Unit) -> DataType {
    match unit {
        Unit::MILLIS => DataType::Time32(TimeUnit::Millisecond),
        Unit::MICROS => DataType::Time64(TimeUnit::Microsecond),
        Unit::NANOS => DataType::Time64(TimeUnit::Nanosecond),
    }
}

fn timestamp(unit: Unit, is_utc: bool) -> DataType {
    let unit = match unit {
        Unit::MILLIS => TimeUnit::Millisecond,
        Unit::MICROS => TimeUnit::Microsecond,
        Unit::NANOS => TimeUnit::Nanosecond,
    };
    DataType::Timestamp(unit, is_utc.then(|| "UTC".into()))
}
