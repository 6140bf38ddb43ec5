//! Arrays under the names that Abaqus gives them.

/// Our name of an array, and that of Abaqus.
const NAMES: [(&str, &str); 12] = [
    ("displacement", "U"),
    ("contact_force", "CFORCE"),
    ("support_force", "RF"),
    ("stress", "S"),
    ("von_mises", "MISES"),
    ("principal_stress", "SP"),
    ("strain", "E"),
    ("pressure", "CPRESS"),
    ("friction_traction", "CSHEAR"),
    ("gap", "COPEN"),
    ("slip", "CSLIP"),
    ("state", "CSTATUS"),
];

/// A VTU document with the names of Abaqus; `CSHEAR` and `CSLIP` stay vectors in global axes, which Abaqus
/// splits along two directions of the surface.
#[must_use]
pub fn abaqus_names(document: &str) -> String {
    let mut text = String::with_capacity(document.len());
    for line in document.split_inclusive('\n') {
        // Lines of numbers may be very long.
        let array = line.starts_with("<DataArray");
        let named = |(own, _): &&(&str, &str)| line.contains(&format!(" Name=\"{own}\" "));
        match NAMES.iter().filter(|_| array).find(named) {
            Some((own, other)) => {
                text += &line.replace(&format!("Name=\"{own}\""), &format!("Name=\"{other}\""));
            }
            None => text += line,
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrays_are_renamed_and_nothing_else() {
        let own = "<!-- Name=\"gap\" -->\n<DataArray type=\"Float64\" Name=\"gap\" a=\"1\">\nName=\"gap\" \n\
            <DataArray type=\"Int32\" Name=\"body\" a=\"1\">";
        let expected = own.replacen("64\" Name=\"gap\"", "64\" Name=\"COPEN\"", 1);
        assert_eq!(abaqus_names(own), expected);
    }
}
