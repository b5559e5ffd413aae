"""The export tests' biped as a user's own USD stage: turned in the world, with a scene, joints and drives."""

from __future__ import annotations

from pathlib import Path

from export_robots import SOLE_Z

YAW = "(0.980066578, 0, 0, 0.198669331)"  # 0.4 rad


def _body(name: str, place: str, mass: float, inside: str = "", also: str = "") -> str:
    return f'''
        def Xform "{name}" (prepend apiSchemas = ["PhysicsRigidBodyAPI", "PhysicsMassAPI"{also}])
        {{
            double3 xformOp:translate = {place}
            uniform token[] xformOpOrder = ["xformOp:translate"]
            float physics:mass = {mass}
            float3 physics:diagonalInertia = (0.3, 0.3, 0.3)
            quatf physics:principalAxes = (1, 0, 0, 0)
            {inside}
        }}'''


def _box(name: str, size: str, place: str, binding: str = "") -> str:
    schemas = '"PhysicsCollisionAPI"' + (', "MaterialBindingAPI"' if binding else "")
    return f'''
            def Cube "{name}" (prepend apiSchemas = [{schemas}])
            {{
                double size = 1
                float3[] extent = [(-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)]
                double3 xformOp:translate = {place}
                float3 xformOp:scale = {size}
                uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:scale"]
                {binding}
            }}'''


def _joint(name: str, bodies: tuple[str, str], at: str, drive: bool) -> str:
    kind, schemas = (
        ("PhysicsRevoluteJoint", '"PhysicsDriveAPI:angular"') if drive else ("PhysicsFixedJoint", "")
    )
    first = f"rel physics:body0 = </World/biped/{bodies[0]}>" if bodies[0] else ""
    driven = """uniform token physics:axis = "Y"
            uniform token drive:angular:physics:type = "force"
            float drive:angular:physics:stiffness = 1e6
            float drive:angular:physics:damping = 1e4"""
    return f'''
        def {kind} "{name}" ({f"prepend apiSchemas = [{schemas}]" if drive else ""})
        {{
            {first}
            rel physics:body1 = </World/biped/{bodies[1]}>
            point3f physics:localPos0 = {at}
            quatf physics:localRot0 = {YAW if not bodies[0] else "(1, 0, 0, 0)"}
            point3f physics:localPos1 = (0, 0, 0)
            quatf physics:localRot1 = (1, 0, 0, 0)
            {driven if drive else ""}
        }}'''


def write_usd(path: Path) -> Path:
    """A stage whose pelvis hangs on the world; its ankles are driven, its soles are one box each, of rubber."""
    rubber = "rel material:binding:physics = </World/rubber>"
    parts = [_body("pelvis", "(0, 0, 0.5)", 20.0, also=', "PhysicsArticulationRootAPI"')]
    parts.append(_joint("held", ("", "pelvis"), "(0, 0, 0.5)", drive=False))
    for side, y in (("left", 0.1), ("right", -0.1)):
        foot = _box("foot", "(0.2, 0.12, 0.04)", f"(0.01, 0, {SOLE_Z + 0.02})", rubber)
        cover = _box("cover", "(0.08, 0.08, 0.05)", "(0, 0, 0)")
        parts.append(_body(f"{side}_shin", f"(0, {y}, 0.5)", 4.0))
        parts.append(_body(f"{side}_ankle", f"(0, {y}, 0.1)", 1.5, cover + foot))
        parts.append(_joint(f"{side}_hip", ("pelvis", f"{side}_shin"), f"(0, {y}, 0)", drive=False))
        parts.append(
            _joint(f"{side}_ankle_pitch", (f"{side}_shin", f"{side}_ankle"), "(0, 0, -0.4)", drive=True)
        )
    path.write_text(f"""#usda 1.0
(
    defaultPrim = "World"
    metersPerUnit = 1
    kilogramsPerUnit = 1
    upAxis = "Z"
)

def PhysicsScene "scene"
{{
    float physics:gravityMagnitude = 0
}}

def Xform "World"
{{
    def Material "rubber" (prepend apiSchemas = ["PhysicsMaterialAPI"])
    {{
        float physics:staticFriction = 0.9
        float physics:dynamicFriction = 0.8
    }}

    def Xform "biped"
    {{
        quatd xformOp:orient = {YAW}
        uniform token[] xformOpOrder = ["xformOp:orient"]
{"".join(parts)}
    }}
}}
""")
    return path
