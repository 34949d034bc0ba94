// Worlds and bodies of the Bullet shim; the API is in discrepancy-finder-bullet.h.
//
// The shim is one translation unit: world.inc has the data structures and the guard that every
// entry passes, this file worlds and bodies, and each of the other parts one subject.

#include "discrepancy-finder-bullet.h"
#include "world.inc"
#include "hulls.inc"
#include "shapes.inc"
#include "contacts.inc"
#include "placing.inc"
#include "grips.inc"
#include "constraints.inc"
#include "joints.inc"
#include "queries.inc"
#include "rays.inc"
#include "sweeps.inc"
#include "mechanisms.inc"
#include "kinematics.inc"
#include "courses.inc"
#include "watches.inc"
#include "held-bodies.inc"
#include "surveys.inc"
#include "motion-runs.inc"
#include "clearances.inc"
#include "checkpoint-data.inc"
#include "checkpoints.inc"

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

int dfb_body_new(dfb_world *world, const dfb_shape *shape, int kind, const double *pose_numbers,
                 const double *mass_numbers, const double *material) {
  return enter(world, [&]() -> int {
    if (!is_shape(shape)) return DFB_BAD_SHAPE;
    btCollisionShape *form = shape->shape->form.get();
    const bool dynamic = kind == DFB_DYNAMIC;
    if (!dynamic && kind != DFB_STATIC && kind != DFB_KINEMATIC) return DFB_BAD_KIND;
    if (form->getShapeType() == STATIC_PLANE_PROXYTYPE && kind != DFB_STATIC) return DFB_BAD_KIND;
    btTransform pose;
    Body body;
    body.kind = kind;
    body.shape = shape->shape;
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
