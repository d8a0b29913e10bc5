//! Prints the JSON Schema of the arm file, for `schema/arm.schema.json`.

fn main() {
    print!("{}", hydrostat_files::schema::arm_schema_text());
}
