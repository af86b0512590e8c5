"""What the models' scripts have in common: an armature, meshes skinned to it, and the export to glTF."""
import bpy


def empty_scene(frames_per_second, first_frame, last_frame):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = frames_per_second
    scene.frame_start, scene.frame_end = first_frame, last_frame


def make_armature(name, bones):
    """bones: {name: (head, tail, parent or None)}, parents first."""
    armature = bpy.data.armatures.new(name)
    rig = bpy.data.objects.new(name, armature)
    bpy.context.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    for bone_name, (head, tail, parent) in bones.items():
        bone = armature.edit_bones.new(bone_name)
        bone.head, bone.tail = head, tail
        bone.roll = 0.0
        if parent:
            bone.parent = armature.edit_bones[parent]
    bpy.ops.object.mode_set(mode="OBJECT")
    return rig


def new_mesh(name, vertices, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([tuple(v) for v in vertices], [], [tuple(f) for f in faces])
    return mesh


def add_skinned(name, mesh, groups, rig):
    """An object of the mesh that follows the rig. groups: {bone: weight} of each vertex."""
    for polygon in mesh.polygons:
        polygon.use_smooth = True
    thing = bpy.data.objects.new(name, mesh)
    bpy.context.collection.objects.link(thing)
    for vertex, weights in enumerate(groups):
        for bone, weight in weights.items():
            group = thing.vertex_groups.get(bone) or thing.vertex_groups.new(name=bone)
            group.add([vertex], weight, "REPLACE")
    thing.parent = rig
    thing.modifiers.new("Armature", "ARMATURE").object = rig
    return thing


def export(target, sampled, texture_coordinates):
    """sampled: keys for every frame instead of splines. As splines, Blender 3.4 writes the quaternions of bones that
    point against their parent, as arms and legs do, with signs that change from key to key; a spline between q and -q
    turns the limb around once in some 20 ms."""
    bpy.ops.export_scene.gltf(
        filepath=target, export_format="GLB", export_yup=True, export_animations=True, export_skins=True,
        export_force_sampling=sampled, export_normals=False, export_colors=True, export_morph=False,
        export_texcoords=texture_coordinates, export_image_format="NONE", export_def_bones=False,
        export_optimize_animation_size=False)
