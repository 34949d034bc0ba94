/* C API of the Bullet shim: rigid-body worlds for a caller that has no C++.
 *
 * A world is an opaque handle.  Shapes, bodies and attachments are ids inside of one world:
 * integers from 0, in the order of their making.  A function that makes something returns its id,
 * every other one DFB_OK or what its comment says; a negative result is one of the statuses below,
 * and then nothing was changed and no output was written.  Handles are checked at each entry, ids
 * for bounds and liveness, numbers for being finite (at most 1e9 in magnitude).
 *
 * A pose is x, y, z (m) and a unit quaternion qx, qy, qz, qw.  The state of a body is 13 doubles:
 * its pose, its linear velocity (m/s), its angular velocity (rad/s).  SI units everywhere.
 *
 * The float environment of the caller is put aside during each call, so that a caller may keep
 * float traps on.  No exception leaves this library, and it has no state outside of the worlds:
 * any thread may use a world, one thread at a time; different worlds need no lock.  Equal calls in
 * equal order give equal bits; queries (reads, penetrations, rays) change no later bit.
 */
#ifndef DISCREPANCY_FINDER_BULLET_H
#define DISCREPANCY_FINDER_BULLET_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define DFB_API __attribute__((visibility("default")))

typedef struct dfb_world dfb_world;

enum dfb_status {
  DFB_OK = 0,
  DFB_BAD_WORLD = -1,       /* the handle is no open world */
  DFB_BAD_BODY = -2,        /* no body has this id, or two bodies are the same one */
  DFB_BAD_SHAPE = -3,       /* no shape has this id, or it cannot be used here */
  DFB_BAD_CONSTRAINT = -4,  /* no live attachment has this id */
  DFB_BAD_NUMBER = -5,      /* not finite, not positive, not of unit length */
  DFB_BAD_KIND = -6,        /* the kind of the body does not allow it */
  DFB_TOO_SMALL = -7,       /* the output has no room for the result */
  DFB_NO_MEMORY = -8,
  DFB_NOTHING = -9,         /* no two bodies penetrate each other */
  DFB_BAD_LINK = -20        /* no mechanism, link or joint has this id, or the tree is none */
};

enum dfb_kind { DFB_STATIC = 0, DFB_DYNAMIC = 1, DFB_KINEMATIC = 2 };

/* Worlds */
/* Return a new world with gravity (m/s^2) along z and a fixed time step (s), or NULL. */
DFB_API dfb_world *dfb_world_new(double gravity, double time_step);
/* Free the world with all that is in it. */
DFB_API int dfb_world_delete(dfb_world *world);
/* Advance the world by a number of time steps. */
DFB_API int dfb_step(dfb_world *world, int steps);

/* Shapes; the origin of a shape is the centre of mass of its body */
/* Return a box with these full extents (m). */
DFB_API int dfb_shape_box(dfb_world *world, double x, double y, double z);
/* Return a sphere (m). */
DFB_API int dfb_shape_sphere(dfb_world *world, double radius);
/* Return a cylinder along z (m). */
DFB_API int dfb_shape_cylinder(dfb_world *world, double radius, double height);
/* Return the half-space of the points p with n.p <= d (m), n a unit vector. */
DFB_API int dfb_shape_plane(dfb_world *world, double nx, double ny, double nz, double d);
/* Return the union of count boxes, spheres and cylinders; seven numbers of poses for each. */
DFB_API int dfb_shape_compound(dfb_world *world, int count, const int *children,
                               const double *poses);

/* Bodies */
/* Return a body.  Mass (kg) and principal moments of inertia (kg m^2) count for dynamic ones only;
 * the friction of a pair is the product of both coefficients, and so is its restitution. */
DFB_API int dfb_body_new(dfb_world *world, int shape, int kind, double x, double y, double z,
                         double qx, double qy, double qz, double qw, double mass, double ix,
                         double iy, double iz, double friction, double rolling_friction,
                         double restitution);
/* Move a kinematic body: at the next step it has the velocity that takes it to this pose. */
DFB_API int dfb_body_move(dfb_world *world, int body, double x, double y, double z, double qx,
                          double qy, double qz, double qw);
/* Put a body of any kind to this pose, at rest; wake it and what touched it. */
DFB_API int dfb_body_place(dfb_world *world, int body, double x, double y, double z, double qx,
                           double qy, double qz, double qw);
/* Wake a dynamic body; nothing happens to others. */
DFB_API int dfb_body_wake(dfb_world *world, int body);
/* Let a dynamic body fall asleep when it rests (flag 1, as at first), or keep it awake (flag 0). */
DFB_API int dfb_body_allow_sleep(dfb_world *world, int body, int flag);
/* Return 1 if the body sleeps, else 0. */
DFB_API int dfb_body_asleep(dfb_world *world, int body);
/* Write the state of a body: 13 doubles. */
DFB_API int dfb_body_read(dfb_world *world, int body, double *state);

/* States of whole worlds */
/* Write the states of all bodies, in the order of their ids, to an output of length doubles. */
DFB_API int dfb_state_read(dfb_world *world, double *states, int length);
/* Write the 64-bit FNV-1a hash of what dfb_state_read writes. */
DFB_API int dfb_state_hash(dfb_world *world, uint64_t *hash);
/* Return 1 if each dynamic body that is not attached sleeps or was slower than 1 mm/s and
 * 0.01 rad/s after each of the last 10 steps, else 0. */
DFB_API int dfb_at_rest(dfb_world *world);

/* Constraints */
/* Fix a dynamic child to a parent where it is; return an attachment.  The two do not collide. */
DFB_API int dfb_attach(dfb_world *world, int parent, int child);
/* Remove an attachment. */
DFB_API int dfb_detach(dfb_world *world, int attachment);
/* Write force (N) and torque about its centre of mass (Nm) on the child in the last step. */
DFB_API int dfb_attachment_load(dfb_world *world, int attachment, double *load);
/* Let two bodies pass through each other (flag 1) or collide again (flag 0). */
DFB_API int dfb_ignore_collision(dfb_world *world, int a, int b, int flag);

/* Queries */
/* Write how deep (m) two bodies penetrate each other; 0 when apart. */
DFB_API int dfb_penetration(dfb_world *world, int a, int b, double *depth);
/* Find the deepest penetration of a pair that collides and has a dynamic body: write its depth and
 * the two bodies, or return DFB_NOTHING. */
DFB_API int dfb_deepest_penetration(dfb_world *world, double *depth, int *a, int *b);

/* Rays */
/* Find the first body on the way from x, y, z to to_x, to_y, to_z (m, at least 1e-9 m apart), the
 * passed_count bodies in passed aside: write it and the hit, 7 doubles: the point (m), the outward
 * normal of the surface there, and the part, 0 to 1, of the way.  Return DFB_NOTHING if there is
 * none.  A body in which the way begins is hit at once, with a normal against the way; what is only
 * touched is hit; of two bodies hit at the same place it is the one with the smaller id. */
DFB_API int dfb_cast_ray(dfb_world *world, double x, double y, double z, double to_x, double to_y,
                         double to_z, int passed_count, const int *passed, int *body, double *hit);
/* The same for count rays of 6 doubles each: write a body for each, -1 for none, and 7 doubles
 * where there is one.  Return the number of rays that hit something. */
DFB_API int dfb_cast_rays(dfb_world *world, int count, const double *rays, int passed_count,
                          const int *passed, int *bodies, double *hits);

/* Mechanisms: trees of links moved by forward kinematics, robots.  A link hangs on a joint, which
 * has the link's index; positions are one double (m or rad) for each joint. */
/* Return a mechanism of count links, parents first.  Each has 4 integers: parent or -1; type, 0
 * fixed, 1 turning, 2 sliding; the joint that it mimics or -1; kinematic body or -1; and 14
 * doubles: pose of the joint in the frame of the parent, unit axis, lower and upper limit (may be
 * infinite), multiplier and offset of the mimicked position. */
DFB_API int dfb_mechanism_new(dfb_world *world, int count, const int *integers,
                              const double *numbers);
/* Move the links' bodies to where base, a pose, and positions put them; with teleport 1 at rest, and
 * with them what is attached to them. */
DFB_API int dfb_mechanism_pose(dfb_world *world, int mechanism, const double *base,
                               const double *positions, int teleport);
/* Write the pose of a link as of the last time that the mechanism was moved. */
DFB_API int dfb_link_pose(dfb_world *world, int mechanism, int link, double *pose);
/* Write the pose that a link would have. */
DFB_API int dfb_forward_kinematics(dfb_world *world, int mechanism, const double *base,
                                   const double *positions, int link, double *pose);
/* Find positions of the joints that take tool, a pose in the frame of link, to target, all others
 * as in start; return how many solutions there are, at most most, and write each: positions.  The
 * attempts from first_attempt on are made: number 0 begins at start, others at random positions.
 * A solution is no farther (m + rad) than tolerance away; with position_only 1 the turn is free.
 * Write the error, m and rad, of the first solution, or of the best attempt. */
DFB_API int dfb_inverse_kinematics(dfb_world *world, int mechanism, int link, const double *base,
                                   const double *tool, const double *target, int joint_count,
                                   const int *joints, const double *start, int position_only,
                                   int attempts, int first_attempt, double tolerance, int most,
                                   double *solutions, double *error);
#ifdef __cplusplus
}
#endif
#endif
