// Worlds, shapes and bodies of the Bullet shim; the API is in discrepancy-finder-bullet.h.
//
// The shim is one translation unit in five parts: world.inc has the data structures and the guard
// that every entry passes, this file worlds, shapes and bodies, constraints.inc attachments and
// ignored collisions, queries.inc and rays.inc all that looks and does not touch.

#include "discrepancy-finder-bullet.h"
#include "world.inc"
#include "hulls.inc"
#include "grips.inc"
#include "constraints.inc"
#include "joints.inc"
#include "queries.inc"
#include "contacts.inc"
#include "rays.inc"
#include "mechanisms.inc"
#include "kinematics.inc"
#include "courses.inc"
#include "watches.inc"
#include "held-bodies.inc"
#include "surveys.inc"
#include "motion-runs.inc"
#include "clearances.inc"

namespace {

int add_shape(dfb_world *world, std::unique_ptr<btCollisionShape> shape) {
  world->shapes.push_back(std::move(shape));
  return static_cast<int>(world->shapes.size()) - 1;
}

// Return a shape that is form moved to pose.
std::unique_ptr<btCollisionShape> shifted_shape(btCollisionShape *form, const btTransform &pose) {
  auto compound = std::make_unique<btCompoundShape>();
  if (form->isCompound()) {
    auto *parts = static_cast<btCompoundShape *>(form);
    for (int i = 0; i < parts->getNumChildShapes(); i++)
      compound->addChildShape(pose * parts->getChildTransform(i), parts->getChildShape(i));
  } else {
    compound->addChildShape(pose, form);
  }
  return compound;
}

}  // namespace

extern "C" {

dfb_world *dfb_world_new(double gravity, double time_step) {
  FloatEnvironment guard;
  if (!usable(gravity) || !positive(time_step)) return nullptr;
  try {
    return new dfb_world(gravity, time_step);
  } catch (...) {
    return nullptr;
  }
}

int dfb_world_delete(dfb_world *world) {
  return enter(world, [&] {
    delete world;
    return DFB_OK;
  });
}

int dfb_step(dfb_world *world, int steps) {
  return enter(world, [&] {
    if (steps < 0) return DFB_BAD_NUMBER;
    for (int i = 0; i < steps; i++) advance(world);
    return DFB_OK;
  });
}

int dfb_shape_box(dfb_world *world, double x, double y, double z) {
  return enter(world, [&]() -> int {
    if (!positive(x) || !positive(y) || !positive(z)) return DFB_BAD_NUMBER;
    return add_shape(world, std::make_unique<btBoxShape>(btVector3(x / 2, y / 2, z / 2)));
  });
}

int dfb_shape_sphere(dfb_world *world, double radius) {
  return enter(world, [&]() -> int {
    if (!positive(radius)) return DFB_BAD_NUMBER;
    return add_shape(world, std::make_unique<btSphereShape>(radius));
  });
}

int dfb_shape_cylinder(dfb_world *world, double radius, double height) {
  return enter(world, [&]() -> int {
    if (!positive(radius) || !positive(height)) return DFB_BAD_NUMBER;
    return add_shape(world,
                     std::make_unique<btCylinderShapeZ>(btVector3(radius, radius, height / 2)));
  });
}

int dfb_shape_plane(dfb_world *world, double nx, double ny, double nz, double d) {
  return enter(world, [&]() -> int {
    if (!usable(nx) || !usable(ny) || !usable(nz) || !usable(d) ||
        !unit(nx * nx + ny * ny + nz * nz))
      return DFB_BAD_NUMBER;
    return add_shape(world, std::make_unique<btStaticPlaneShape>(btVector3(nx, ny, nz), d));
  });
}

int dfb_shape_compound(dfb_world *world, int count, const int *children, const double *poses) {
  return enter(world, [&]() -> int {
    if (count < 1) return DFB_BAD_SHAPE;
    auto compound = std::make_unique<btCompoundShape>(true, count);
    for (int i = 0; i < count; i++) {
      if (children[i] < 0 || children[i] >= static_cast<int>(world->shapes.size()))
        return DFB_BAD_SHAPE;
      btCollisionShape *child = world->shapes[children[i]].get();
      if (!child->isConvex()) return DFB_BAD_SHAPE;
      const double *p = poses + 7 * i;
      btTransform pose;
      if (!make_pose(pose, p[0], p[1], p[2], p[3], p[4], p[5], p[6])) return DFB_BAD_NUMBER;
      compound->addChildShape(pose, child);
    }
    return add_shape(world, std::move(compound));
  });
}

int dfb_body_new(dfb_world *world, int shape, int kind, const double *pose_numbers,
                 const double *mass_numbers, const double *material) {
  return enter(world, [&]() -> int {
    if (shape < 0 || shape >= static_cast<int>(world->shapes.size())) return DFB_BAD_SHAPE;
    btCollisionShape *form = world->shapes[shape].get();
    const bool dynamic = kind == DFB_DYNAMIC;
    if (!dynamic && kind != DFB_STATIC && kind != DFB_KINEMATIC) return DFB_BAD_KIND;
    if (form->getShapeType() == STATIC_PLANE_PROXYTYPE && kind != DFB_STATIC) return DFB_BAD_KIND;
    btTransform pose;
    Body body;
    body.kind = kind;
    if (!make_pose(pose, pose_numbers)) return DFB_BAD_NUMBER;
    if (dynamic) {
      for (int i = 0; i < 4; i++)
        if (!positive(mass_numbers[i])) return DFB_BAD_NUMBER;
      if (!make_pose(body.inertial, mass_numbers + 4)) return DFB_BAD_NUMBER;
      body.offset = !(body.inertial == btTransform::getIdentity());
      body.link = body.inertial.inverse();
    }
    for (int i = 0; i < 5; i++)
      if (!usable(material[i]) || material[i] < 0 || (i >= 2 && material[i] > 1))
        return DFB_BAD_NUMBER;
    if (body.offset) {
      body.shifted = shifted_shape(form, body.link);
      form = body.shifted.get();
    }
    const btVector3 moments(mass_numbers[1], mass_numbers[2], mass_numbers[3]);
    btRigidBody::btRigidBodyConstructionInfo info(dynamic ? mass_numbers[0] : 0, nullptr, form,
                                                  moments);
    info.m_startWorldTransform = inertial_pose(body, pose);
    info.m_friction = material[0];
    info.m_rollingFriction = material[1];
    info.m_spinningFriction = material[1];
    info.m_restitution = material[2];
    info.m_linearDamping = material[3];
    info.m_angularDamping = material[4];
    info.m_linearSleepingThreshold = kSleepSpeed;
    info.m_angularSleepingThreshold = kSleepTurn;
    body.rigid = std::make_unique<btRigidBody>(info);
    if (kind == DFB_KINEMATIC)
      body.rigid->setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    const int id = static_cast<int>(world->bodies.size());
    if (dynamic) world->dynamic_bodies.reserve(world->dynamic_bodies.size() + 1);
    world->bodies.push_back(std::move(body));
    if (dynamic) world->dynamic_bodies.push_back(id);
    enlist(world, world->bodies[id]);
    return id;
  });
}

int dfb_body_move(dfb_world *world, int id, double x, double y, double z, double qx, double qy,
                  double qz, double qw) {
  return enter_lightly(world, [&] {
    Body *body = find_body(world, id);
    if (!body) return DFB_BAD_BODY;
    if (body->kind != DFB_KINEMATIC) return DFB_BAD_KIND;
    btTransform pose;
    if (!make_pose(pose, x, y, z, qx, qy, qz, qw)) return DFB_BAD_NUMBER;
    move(world, *body, pose);
    return DFB_OK;
  });
}

int dfb_body_place(dfb_world *world, int id, double x, double y, double z, double qx, double qy,
                   double qz, double qw) {
  return enter(world, [&] {
    Body *body = find_body(world, id);
    if (!body) return DFB_BAD_BODY;
    btTransform pose;
    if (!make_pose(pose, x, y, z, qx, qy, qz, qw)) return DFB_BAD_NUMBER;
    place(world, *body, pose);
    return DFB_OK;
  });
}

int dfb_body_wake(dfb_world *world, int id) {
  return enter(world, [&] {
    Body *body = find_body(world, id);
    if (!body) return DFB_BAD_BODY;
    if (body->kind == DFB_DYNAMIC) body->rigid->activate(true);
    return DFB_OK;
  });
}

int dfb_body_allow_sleep(dfb_world *world, int id, int flag) {
  return enter(world, [&] {
    Body *body = find_body(world, id);
    if (!body) return DFB_BAD_BODY;
    if (body->kind != DFB_DYNAMIC) return DFB_BAD_KIND;
    body->may_sleep = flag != 0;
    refresh_activation(*body);
    return DFB_OK;
  });
}

}  // extern "C"
