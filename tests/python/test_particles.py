"""Particles of X3D in pictures: an instant is the same picture however it is reached."""
FIRE = """#X3D V3.3 utf8
PROFILE Full
Viewpoint { position 0 0.5 3 }
DEF Fire ParticleSystem {
  geometryType "SPRITE" maxParticles 200 particleLifetime 2 particleSize 0.2 0.2
  emitter ConeEmitter { angle 0.4 speed 0.6 mass 0.01 surfaceArea 0.001 }
  physics [
    WindPhysicsModel { direction 1 0 0 speed 2 gustiness 0.5 turbulence 0.2 }
    BoundedPhysicsModel { geometry IndexedFaceSet { coordIndex [ 0 1 2 3 -1 ]
      coord Coordinate { point [ -9 1 9, 9 1 9, 9 1 -9, -9 1 -9 ] } } }
  ]
  colorKey [ 0, 0.3, 1 ]
  colorRamp ColorRGBA { color [ 1 1 0.5 1, 1 0.3 0 0.8, 0.1 0.1 0.1 0 ] }
}
"""


def drawn(vv, world, output, *options):
    done = vv(world, "-o", output, "--size", "40x30", "--spp", "4", "-q", *options)
    assert done.returncode == 0, done.talk
    return (vv.folder / output).read_bytes() if "{" not in output else b""


def test_a_fire_burns_when_the_world_is_opened(vv):
    vv.write("fire.x3dv", FIRE)
    vv.write("cold.x3dv", FIRE.replace("maxParticles 200", "maxParticles 0"))
    assert drawn(vv, "fire.x3dv", "fire.pfm") != drawn(vv, "cold.x3dv", "cold.pfm")


def test_frames_before_and_threads_change_nothing(vv):
    vv.write("fire.x3dv", FIRE)
    drawn(vv, "fire.x3dv", "f{frame}.pfm", "--frames", "0-12/3", "--fps", "10")
    frames = {number: (vv.folder / f"f{number}.pfm").read_bytes() for number in (0, 3, 12)}
    at = ("--time", "1.2")
    assert frames[12] == drawn(vv, "fire.x3dv", "a.pfm", *at, "--fps", "10", "--threads", "1")
    assert frames[12] == drawn(vv, "fire.x3dv", "b.pfm", *at, "--fps", "40", "--threads", "3")
    assert frames[0] != frames[3]
