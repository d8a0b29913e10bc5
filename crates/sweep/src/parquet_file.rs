//! Columns as Parquet: parts of one row group each, and files of many.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::{Compression, ConvertedType, Encoding, GzipLevel, LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnCloseResult;
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::{KeyValue, ParquetMetaData, ParquetMetaDataReader, RowGroupMetaData};
use parquet::file::properties::WriterProperties;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{ColumnPath, Type, TypePtr};

use crate::column::{Column, Data};
use crate::error::{SweepError, parquet_error, read_error};

/// Whether numbers hardly repeat, by the first ones: then their bytes, taken apart by place, compress better than a
/// dictionary.
fn hardly_repeat(values: &[f64]) -> bool {
    let mut first: Vec<u64> = values.iter().take(256).map(|value| value.to_bits()).collect();
    let count = first.len();
    first.sort_unstable();
    first.dedup();
    2 * first.len() > count
}

fn properties(columns: &[Column], notes: &[(&str, String)]) -> Arc<WriterProperties> {
    let notes = notes.iter().map(|(key, value)| KeyValue::new((*key).to_owned(), value.clone())).collect();
    // Bytes of numbers that were taken apart by place are runs or noise: level 6 makes files 1 % smaller than this.
    let level = GzipLevel::try_new(1).unwrap_or_default();
    let mut builder = WriterProperties::builder()
        .set_compression(Compression::GZIP(level))
        .set_created_by(format!("hydrostat {}", env!("CARGO_PKG_VERSION")))
        .set_key_value_metadata(Some(notes));
    for column in columns {
        if matches!(&column.data, Data::Number(values) if hardly_repeat(values)) {
            let path = ColumnPath::new(vec![column.name.clone()]);
            builder = builder
                .set_column_dictionary_enabled(path.clone(), false)
                .set_column_encoding(path, Encoding::BYTE_STREAM_SPLIT);
        }
    }
    Arc::new(builder.build())
}

fn schema(columns: &[Column]) -> Result<TypePtr, ParquetError> {
    let field = |column: &Column| {
        let physical = match column.data {
            Data::Whole(_) => Physical::INT64,
            Data::Number(_) => Physical::DOUBLE,
            Data::Text(_) => Physical::BYTE_ARRAY,
        };
        let builder = Type::primitive_type_builder(&column.name, physical).with_repetition(Repetition::OPTIONAL);
        let builder = match column.data {
            Data::Text(_) => {
                builder.with_logical_type(Some(LogicalType::String)).with_converted_type(ConvertedType::UTF8)
            }
            _ => builder,
        };
        builder.build().map(Arc::new)
    };
    let fields = columns.iter().map(field).collect::<Result<_, _>>()?;
    Ok(Arc::new(Type::group_type_builder("sweep").with_fields(fields).build()?))
}

/// A file of one row group.
pub(crate) fn part(columns: &[Column]) -> Result<Vec<u8>, ParquetError> {
    let mut writer = SerializedFileWriter::new(Vec::new(), schema(columns)?, properties(columns, &[]))?;
    let mut group = writer.next_row_group()?;
    for column in columns {
        match &column.data {
            Data::Whole(values) => put::<Int64Type>(&mut group, values.iter().copied())?,
            Data::Number(values) => put::<DoubleType>(&mut group, values.iter().map(|v| (!v.is_nan()).then_some(*v)))?,
            Data::Text(values) => {
                let bytes = |text: &Option<String>| text.as_ref().map(|text| ByteArray::from(text.as_str()));
                put::<ByteArrayType>(&mut group, values.iter().map(bytes))?;
            }
        }
    }
    group.close()?;
    writer.into_inner()
}

/// Columns as the bytes of a Parquet file of one row group, which `path` is for.
///
/// # Errors
/// [`SweepError`] when the library cannot write them.
pub fn parquet_bytes(columns: &[Column], path: &Path) -> Result<Vec<u8>, SweepError> {
    part(columns).map_err(|error| parquet_error(path, error))
}

fn put<T: DataType>(
    group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
    values: impl Iterator<Item = Option<T::T>>,
) -> Result<(), ParquetError> {
    let (mut levels, mut given) = (Vec::new(), Vec::new());
    for value in values {
        levels.push(i16::from(value.is_some()));
        given.extend(value);
    }
    if let Some(mut column) = group.next_column()? {
        column.typed::<T>().write_batch(&given, Some(&levels), None)?;
        column.close()?;
    }
    Ok(())
}

/// Writes the row groups of `parts`, unchanged, to `out` as one file with `notes` about it.
pub(crate) fn join(
    parts: &[PathBuf],
    columns: &[Column],
    notes: &[(&str, String)],
    path: &Path,
    out: &mut (impl Write + Send),
) -> Result<(), SweepError> {
    let failed = |error| parquet_error(path, error);
    let schema = schema(columns).map_err(failed)?;
    let mut writer =
        SerializedFileWriter::new(BufWriter::new(out), schema.clone(), properties(&[], notes)).map_err(failed)?;
    for part in parts {
        let file = File::open(part).map_err(|error| read_error(part, error))?;
        let metadata = ParquetMetaDataReader::new().parse_and_finish(&file).map_err(|error| read_error(part, error))?;
        check_places(part, &metadata)?;
        if metadata.file_metadata().schema_descr().root_schema() != &*schema {
            return Err(read_error(part, "expected the columns of this sweep, found others"));
        }
        for group in metadata.row_groups() {
            let mut joined = writer.next_row_group().map_err(failed)?;
            for column in group.columns() {
                let close = ColumnCloseResult {
                    bytes_written: u64::try_from(column.compressed_size()).unwrap_or_default(),
                    rows_written: u64::try_from(group.num_rows()).unwrap_or_default(),
                    metadata: column.clone(),
                    bloom_filter: None,
                    column_index: None,
                    offset_index: None,
                };
                joined.append_column(&file, close).map_err(failed)?;
            }
            joined.close().map_err(failed)?;
        }
    }
    writer.finish().map_err(failed)?;
    writer.inner_mut().flush().map_err(|error| crate::error::write_error(path, error))
}

/// Whether columns begin within the file: reader and writer trust the numbers that say where to be none below zero.
fn check_places(path: &Path, metadata: &ParquetMetaData) -> Result<(), SweepError> {
    let mut columns = metadata.row_groups().iter().flat_map(RowGroupMetaData::columns);
    let placed = columns.all(|column| {
        let dictionary = column.dictionary_page_offset().unwrap_or(0);
        column.data_page_offset() >= 0 && dictionary >= 0 && column.compressed_size() >= 0
    });
    if placed {
        Ok(())
    } else {
        Err(read_error(path, "expected columns that begin within the file, found one before its begin"))
    }
}

/// All columns of a Parquet file of this program.
///
/// # Errors
/// [`SweepError`] when it cannot be read, or has columns that no table here has.
pub fn parquet_columns(path: &Path) -> Result<Vec<Column>, SweepError> {
    let reader = Reader::open(path)?;
    let mut out = Vec::new();
    for name in reader.names() {
        out.extend(reader.column(&name)?);
    }
    Ok(out)
}

/// A file that is read column by column.
pub(crate) struct Reader {
    path: PathBuf,
    file: SerializedFileReader<File>,
}

impl Reader {
    pub(crate) fn open(path: &Path) -> Result<Self, SweepError> {
        let file = File::open(path).map_err(|error| read_error(path, error))?;
        let file = SerializedFileReader::new(file).map_err(|error| read_error(path, error))?;
        check_places(path, file.metadata())?;
        Ok(Self { path: path.to_owned(), file })
    }

    /// What is noted about the file under `key`.
    pub(crate) fn note(&self, key: &str) -> Option<String> {
        let notes = self.file.metadata().file_metadata().key_value_metadata()?;
        notes.iter().find(|note| note.key == key)?.value.clone()
    }

    /// The names of all columns.
    pub(crate) fn names(&self) -> Vec<String> {
        let schema = self.file.metadata().file_metadata().schema_descr();
        schema.columns().iter().map(|column| column.name().to_owned()).collect()
    }

    /// The column `name`, `None` where there is none.
    pub(crate) fn column(&self, name: &str) -> Result<Option<Column>, SweepError> {
        let Some(index) = self.names().iter().position(|own| own == name) else { return Ok(None) };
        let physical = self.file.metadata().file_metadata().schema_descr().column(index).physical_type();
        let read = || -> Result<Data, ParquetError> {
            Ok(match physical {
                Physical::INT64 => Data::Whole(self.values::<Int64Type>(index)?),
                Physical::DOUBLE => {
                    let values = self.values::<DoubleType>(index)?;
                    Data::Number(values.into_iter().map(|value| value.unwrap_or(f64::NAN)).collect())
                }
                Physical::BYTE_ARRAY => {
                    let text = |bytes: ByteArray| bytes.as_utf8().map(str::to_owned);
                    let values = self.values::<ByteArrayType>(index)?;
                    Data::Text(values.into_iter().map(|value| value.map(text).transpose()).collect::<Result<_, _>>()?)
                }
                other => return Err(ParquetError::General(format!("expected a column of a sweep, found {other}"))),
            })
        };
        // Pages that are not what the file's end says are a panic in places of the reader (parquet 60): without a dictionary, for one.
        let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(read));
        let damaged = || Err(ParquetError::General(format!("the column \"{name}\" is damaged")));
        let data = outcome.unwrap_or_else(|_| damaged()).map_err(|error| read_error(&self.path, error))?;
        Ok(Some(Column { name: name.to_owned(), data }))
    }

    fn values<T: DataType>(&self, index: usize) -> Result<Vec<Option<T::T>>, ParquetError> {
        let mut out = Vec::new();
        for k in 0..self.file.num_row_groups() {
            let group = self.file.get_row_group(k)?;
            let rows = usize::try_from(group.metadata().num_rows()).unwrap_or_default();
            let reader = group.get_column_reader(index)?;
            let mut reader = parquet::column::reader::get_typed_column_reader::<T>(reader);
            let (mut levels, mut values) = (Vec::new(), Vec::new());
            let mut read = 0;
            while read < rows {
                let (records, _, _) = reader.read_records(rows - read, Some(&mut levels), None, &mut values)?;
                if records == 0 {
                    return Err(ParquetError::General(format!("expected {rows} rows in a group, found {read}")));
                }
                read += records;
            }
            let mut given = values.into_iter();
            out.extend(levels.iter().map(|level| if *level == 0 { None } else { given.next() }));
        }
        Ok(out)
    }
}
