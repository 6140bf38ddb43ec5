//! Meshes that are whole but of no use as stated are refused with what to do about them.

use dpana::mesh_file::gmsh;
use dpana::scene::{SceneContact, SceneObstacle};
use dpana::solve;

use crate::stacks::{body, contact, scene};

/// Two unit squares with a common side; `groups` are those of the side, of the left and the right one.
fn squares(groups: [u32; 3]) -> String {
    let [side, left, right] = groups;
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
        $Nodes\n6\n1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n6 2 1 0\n$EndNodes\n\
        $Elements\n3\n1 1 2 {side} 1 2 5\n2 3 2 {left} 1 1 2 5 4\n3 3 2 {right} 1 2 3 6 5\n$EndElements\n"
    )
}

/// The message of two squares of which `own` touches a floor, or the group `against`.
fn refusal(text: &str, own: &str, against: Option<&str>) -> String {
    let mesh = gmsh::parse(text, "part.msh").unwrap();
    let pair = match against {
        Some(against) => contact(["part", own], ["part", against], 0.3),
        None => {
            let floor = SceneObstacle::plane(&[0.0, 0.0], &[0.0, 1.0]);
            SceneContact::on(floor, own, 0.3).of("part")
        }
    };
    let scene = scene(vec![body("part", mesh, 1000.0, 0.3)], vec![pair]);
    solve(&scene).unwrap_err().to_string()
}

fn says(said: &str, parts: &[&str]) {
    for part in parts {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
}

#[test]
fn a_mesh_without_groups_is_told_of_physical_groups() {
    let said = refusal(&squares([0, 0, 0]), "contact", None);
    says(
        &said,
        &[
            "contacts[0].group",
            "group `contact` of a mesh without groups",
            "Physical Surface",
        ],
    );
    // With groups, they are listed instead.
    let said = refusal(&squares([5, 6, 6]), "contact", None);
    says(&said, &["there is no group `contact`", "one of `5`, `6`"]);
}

#[test]
fn bodies_that_share_the_nodes_between_them_are_told_to_have_their_own() {
    let said = refusal(&squares([5, 6, 7]), "5", Some("5"));
    says(
        &said,
        &[
            "contacts[0].group",
            "[1, 4]",
            "belongs to 2 cells",
            "nodes of its own",
        ],
    );
}

#[test]
fn the_boundary_of_a_body_is_no_mesh_of_it() {
    // The skin of a tetrahedron: four triangles in space.
    let skin = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
        $Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n\
        $Elements\n4\n1 2 2 1 1 1 3 2\n2 2 2 1 1 1 2 4\n3 2 2 1 1 2 3 4\n4 2 2 1 1 1 4 3\n$EndElements\n";
    let said = gmsh::parse(skin, "skin.msh").unwrap_err().to_string();
    says(
        &said,
        &[
            "skin.msh:",
            "node 4 of a plane mesh lies at z = 1",
            "`gmsh -3`",
        ],
    );

    // The lines around a triangle.
    let outline = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n\
        $Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n\
        $Elements\n3\n1 1 2 1 1 1 2\n2 1 2 1 1 2 3\n3 1 2 1 1 3 1\n$EndElements\n";
    let said = gmsh::parse(outline, "outline.msh").unwrap_err().to_string();
    says(
        &said,
        &["outline.msh:", "no cell", "`gmsh -2`", "physical group"],
    );

    // A flat face in a scene of solids, which state no plane model.
    let mesh = gmsh::parse(squares([5, 6, 6]), "face.msh").unwrap();
    let mut part = body("part", mesh, 1000.0, 0.3);
    part.model = None;
    let pair = contact(["part", "5"], ["part", "5"], 0.3);
    let said = solve(&scene(vec![part], vec![pair]))
        .unwrap_err()
        .to_string();
    says(
        &said,
        &[
            "bodies[0].model: nothing is not accepted",
            "plane_strain",
            "`gmsh -3`",
        ],
    );
}
