//! Every command that gprMax 4.0.1 knows, and what becomes of it here.

/// What becomes of a command.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CommandKind {
    /// Read into the model; may stand once.
    Single,
    /// Read into the model; may stand any number of times.
    Multiple,
    /// Does not change a trace: kept as a note that says so.
    Noted(&'static str),
    /// Only gprMax itself can do it.
    GprMaxOnly,
    /// gprMax 4 no longer has it; what to write instead.
    Retired(&'static str),
}

use CommandKind::{GprMaxOnly, Multiple, Noted, Retired, Single};

/// The commands of gprMax 4.0.1 without `#`, and those that older versions had.
pub const COMMANDS: &[(&str, CommandKind)] = &[
    ("domain", Single),
    ("domain_mode", Single),
    ("dx_dy_dz", Single),
    ("time_window", Single),
    ("title", Single),
    ("omp_threads", Single),
    ("num_threads", Single),
    ("pml_cells", Single),
    ("pml_formulation", Single),
    ("pml_cfs", Multiple),
    ("time_step_stability_factor", Single),
    ("dispersive_averaging", Single),
    ("magnetic_averaging", Single),
    ("src_steps", Single),
    ("rx_steps", Single),
    ("symmetry_boundary", Multiple),
    ("include_file", Multiple),
    ("material", Multiple),
    ("add_dispersion_debye", Multiple),
    ("add_dispersion_lorentz", Multiple),
    ("add_dispersion_drude", Multiple),
    ("waveform", Multiple),
    ("excitation_file", Multiple),
    ("hertzian_dipole", Multiple),
    ("magnetic_dipole", Multiple),
    ("voltage_source", Multiple),
    ("rx", Multiple),
    ("rx_array", Multiple),
    ("box", Multiple),
    ("cylinder", Multiple),
    ("sphere", Multiple),
    ("triangle", Multiple),
    ("ellipsoid", Multiple),
    ("cone", Multiple),
    ("cylindrical_sector", Multiple),
    ("plate", Multiple),
    ("edge", Multiple),
    ("soil_peplinski", Multiple),
    ("material_range", Multiple),
    ("material_list", Multiple),
    ("fractal_box", Multiple),
    ("add_surface_roughness", Multiple),
    ("add_surface_water", Multiple),
    ("geometry_objects_read", Multiple),
    ("geometry_objects_write", Multiple),
    ("snapshot", Multiple),
    ("geometry_view", Multiple),
    ("output_dir", Noted("the output goes where the command line says")),
    ("study", GprMaxOnly),
    ("array_codebook", GprMaxOnly),
    ("transmission_line", GprMaxOnly),
    ("magnetic_frill_source", GprMaxOnly),
    ("plane_wave_angles", GprMaxOnly),
    ("plane_wave_axial", GprMaxOnly),
    ("plane_wave_vector", GprMaxOnly),
    ("pml_slab", GprMaxOnly),
    ("material_crim", GprMaxOnly),
    ("material_from_database", GprMaxOnly),
    ("material_density", GprMaxOnly),
    ("python", GprMaxOnly),
    ("end_python", GprMaxOnly),
    ("rational_network", GprMaxOnly),
    ("surface_impedance", GprMaxOnly),
    ("network_terminal", GprMaxOnly),
    ("network_excitation", GprMaxOnly),
    ("network_port", GprMaxOnly),
    ("eigenmode_band", GprMaxOnly),
    ("eigenmode_port", GprMaxOnly),
    ("eigenmode_excitation", GprMaxOnly),
    ("eigenmode_field_output", GprMaxOnly),
    ("virtual_waveguide", GprMaxOnly),
    ("sar", GprMaxOnly),
    ("radiometry", GprMaxOnly),
    ("ntff_surface", GprMaxOnly),
    ("ntff_frequency", GprMaxOnly),
    ("ntff_layered_background", GprMaxOnly),
    ("ntff_layered_frequency", GprMaxOnly),
    ("ntff_layered_time", GprMaxOnly),
    ("ntff_layered_time_far_field", GprMaxOnly),
    ("ntff_layered_time_far_field_array", GprMaxOnly),
    ("ntff_far_field", GprMaxOnly),
    ("ntff_far_field_array", GprMaxOnly),
    ("ntff_time_far_field", GprMaxOnly),
    ("ntff_time_far_field_array", GprMaxOnly),
    ("ntff_antenna_ports", GprMaxOnly),
    ("ksir_frequency", GprMaxOnly),
    ("ksir_time_rx", GprMaxOnly),
    ("ksir_time_rx_spherical", GprMaxOnly),
    ("ksir_time_rx_array", GprMaxOnly),
    ("ksir_frequency_rx", GprMaxOnly),
    ("ksir_frequency_rx_spherical", GprMaxOnly),
    ("ksir_frequency_rx_array", GprMaxOnly),
    ("ksir_far_field", GprMaxOnly),
    ("ksir_far_field_array", GprMaxOnly),
    ("ksir_antenna_ports", GprMaxOnly),
    ("magnetic_edge", GprMaxOnly),
    ("thin_wire", GprMaxOnly),
    ("add_grass", GprMaxOnly),
    ("rx_port", Retired("a voltage source of gprMax 4 records its port itself")),
    ("messages", Retired("remove it: gprMax 4 takes `--log-level` on its command line instead")),
    ("pml_properties", Retired("write `#pml_cells` and `#pml_formulation`")),
    ("plane_voltage_source", Retired("gprMax 4 has no such command")),
    ("discrete_plane_wave", Retired("write `#plane_wave_angles`, `#plane_wave_axial` or `#plane_wave_vector`")),
    ("plane_wave", Retired("write `#plane_wave_angles`, `#plane_wave_axial` or `#plane_wave_vector`")),
];

/// Looks a command up.
pub(super) fn kind_of(name: &str) -> Option<CommandKind> {
    COMMANDS.iter().find(|(known, _)| *known == name).map(|(_, kind)| *kind)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// No command stands twice in the table.
    #[test]
    fn the_table_has_each_command_once() {
        let mut names: Vec<_> = COMMANDS.iter().map(|(name, _)| *name).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), COMMANDS.len());
    }
}
