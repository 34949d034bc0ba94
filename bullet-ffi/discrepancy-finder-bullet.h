/* C API of the Bullet shim: rigid-body worlds for a caller that has no C++.
 *
 * Worlds and shapes are opaque handles.  Bodies, attachments and joints are ids inside of one
 * world: integers from 0, in the order of their making.  A function that makes something returns
 * its id, every other one DFB_OK or what its comment says; a negative result is one of the
 * statuses below, and then nothing was changed and no output was written.  Handles are checked at
 * each entry, ids for bounds and liveness, numbers for being finite (at most 1e9 in magnitude);
 * a positive number is at least 1e-30.
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
typedef struct dfb_shape dfb_shape;

enum dfb_status {
  DFB_OK = 0,
  DFB_BAD_WORLD = -1,       /* the handle is no open world */
  DFB_BAD_BODY = -2,        /* no body has this id, or two bodies are the same one */
  DFB_BAD_SHAPE = -3,       /* the handle is no shape, or it cannot be used here */
  DFB_BAD_CONSTRAINT = -4,  /* no live attachment or joint has this id */
  DFB_BAD_NUMBER = -5,      /* not finite, not positive, not of unit length */
  DFB_BAD_KIND = -6,        /* the kind of the body does not allow it */
  DFB_TOO_SMALL = -7,       /* the output has no room for the result */
  DFB_NO_MEMORY = -8,
  DFB_NOTHING = -9,         /* there is no such thing as was asked for */
  DFB_BAD_CHECKPOINT = -10, /* no checkpoint of such a world */
  DFB_BAD_LINK = -20        /* no mechanism, link or joint has this id, or the tree is none */
};

enum dfb_kind { DFB_STATIC = 0, DFB_DYNAMIC = 1, DFB_KINEMATIC = 2 };

enum dfb_joint_type { DFB_SLIDER = 0, DFB_HINGE = 1, DFB_FIXED = 2, DFB_SIX_DOF = 3 };

/* Worlds */
/* Return a new world with gravity (m/s^2) along z and a fixed time step (s), or NULL. */
DFB_API dfb_world *dfb_world_new(double gravity, double time_step);
/* Free the world with all that is in it. */
DFB_API int dfb_world_delete(dfb_world *world);
/* Advance the world by a number of time steps. */
DFB_API int dfb_step(dfb_world *world, int steps);

/* Shapes: each function writes a new handle.  A shape may be used in any number of worlds and
 * threads, and is freed when neither its handle nor a body needs it; its origin is that of the link
 * frame. */
/* Free the handle of a shape. */
DFB_API int dfb_shape_delete(dfb_shape *shape);
/* Make a box with these full extents (m). */
DFB_API int dfb_shape_box(double x, double y, double z, dfb_shape **shape);
/* Make a sphere (m). */
DFB_API int dfb_shape_sphere(double radius, dfb_shape **shape);
/* Make a cylinder along z (m). */
DFB_API int dfb_shape_cylinder(double radius, double height, dfb_shape **shape);
/* Make the half-space of the points p with n.p <= d (m), n a unit vector. */
DFB_API int dfb_shape_plane(double nx, double ny, double nz, double d, dfb_shape **shape);
/* Make the convex hull of 4 to 40 points of three numbers each (m), nowhere thinner than 1e-5 m. */
DFB_API int dfb_shape_hull(int count, const double *points, dfb_shape **shape);
/* Make the union of count shapes, none a plane or a union; seven numbers of poses for each. */
DFB_API int dfb_shape_compound(int count, dfb_shape *const *children, const double *poses,
                               dfb_shape **shape);

/* Convex hulls */
/* Choose at most most (4 to 40) of count points so that their convex hull leaves little of that of
 * all out; write them, three numbers each, and return how many they are. */
DFB_API int dfb_convex_hull(int count, const double *points, int most, double *corners);
/* Write the moments of the convex hull of 4 to 40 points, 13 doubles: its volume (m^3), the
 * integrals over it of x, y and z, and of their products, a 3 x 3 matrix. */
DFB_API int dfb_hull_moments(int count, const double *points, double *moments);

/* Bodies */
/* Return a body whose link frame is at pose (7 doubles).  The numbers of mass count for a dynamic
 * one only: its mass (kg), three principal moments of inertia (kg m^2), and the pose of their axes
 * in the link frame, whose origin is the centre of mass; 11 in all.  Material is the friction, the
 * rolling friction (m), the restitution, and the linear and angular damping, which are the parts of
 * a velocity that are lost in a second; 5 in all.  The friction of a pair is the product of both
 * coefficients, and so is its restitution. */
DFB_API int dfb_body_new(dfb_world *world, const dfb_shape *shape, int kind, const double *pose,
                         const double *mass, const double *material);
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
/* The same with two fingers that hold by friction.  Point is where they hold, in the child's link
 * frame; axis is on which they close, a unit vector in the parent's.  After each step but the
 * first, with F the force on the child across the axis and T the torque about it at the point,
 * the utilization is the square root of (F/capacity)^2 + (T/(capacity torsion_radius))^2; if it
 * is more than 1, the child is lost: it is detached and keeps its velocity.  Capacity is twice the
 * coefficient of friction times the force of each finger (N), torsion_radius in m. */
DFB_API int dfb_grip(dfb_world *world, int parent, int child, const double *point,
                     const double *axis, double capacity, double torsion_radius);
/* Write the utilization of a grip in the last step (0 for others); return 1 if the attachment
 * holds, 0 if it was removed, 2 if the child was lost. */
DFB_API int dfb_attachment_state(dfb_world *world, int attachment, double *utilization);
/* Remove an attachment. */
DFB_API int dfb_detach(dfb_world *world, int attachment);
/* Write force (N) and torque about its centre of mass (Nm) on the child in the last step. */
DFB_API int dfb_attachment_load(dfb_world *world, int attachment, double *load);
/* Let two bodies pass through each other (flag 1) or collide again (flag 0). */
DFB_API int dfb_ignore_collision(dfb_world *world, int a, int b, int flag);

/* Joints */
/* Join a child that is not static to a parent, or to the world (parent -1), by a joint of a
 * dfb_joint_type; the two do not collide.  Frame (7 doubles) is where the joint is in the world
 * with the bodies as they are, its position 0.  A slider moves along x of the frame, a hinge turns
 * about it: limits are the lowest and the highest position (m, rad).  Those of a six-dof joint are
 * six such pairs: of the moves along x, y and z and of the turns about them.  A pair whose first
 * is greater is no limit. */
DFB_API int dfb_joint_new(dfb_world *world, int type, int parent, int child, const double *frame,
                          const double *limits);
/* Remove a joint. */
DFB_API int dfb_joint_delete(dfb_world *world, int joint);
/* Return 1 if the joint is there, 0 if it was removed or never was. */
DFB_API int dfb_joint_live(dfb_world *world, int joint);
/* Write the position of a slider (m) or a hinge (rad). */
DFB_API int dfb_joint_position(dfb_world *world, int joint, double *position);
/* Put the child of a slider or hinge to where the joint has this position, at rest. */
DFB_API int dfb_joint_place(dfb_world *world, int joint, double position);
/* Let the motor of a slider or hinge strive for a velocity (m/s, rad/s) with at most this force (N,
 * Nm).  Force 0 lets the joint move freely; velocity 0 with a force is friction. */
DFB_API int dfb_joint_motor(dfb_world *world, int joint, double velocity, double force);
/* Write force (N) and torque about its centre of mass (Nm) on the child in the last step. */
DFB_API int dfb_joint_load(dfb_world *world, int joint, double *load);

/* Queries */
/* Write the smallest distance (m) of two bodies, negative if they penetrate each other, or limit if
 * they are farther apart. */
DFB_API int dfb_pair_distance(dfb_world *world, int a, int b, double limit, double *distance);
/* Write how deep (m) two bodies penetrate each other; 0 when apart. */
DFB_API int dfb_penetration(dfb_world *world, int a, int b, double *depth);
/* Find the deepest penetration of a pair that collides and has a dynamic body: write its depth and
 * the two bodies, or return DFB_NOTHING. */
DFB_API int dfb_deepest_penetration(dfb_world *world, double *depth, int *a, int *b);

/* Find the other bodies, the passed_count ones in passed aside, that are not farther than distance
 * from a body: write their ids and for each four numbers, how deep it penetrates (negative: minus
 * the distance) and a point in the midst (m); return how many they are.  There must be room for all
 * bodies of the world. */
DFB_API int dfb_contacts(dfb_world *world, int body, double distance, int passed_count,
                         const int *passed, int *others, double *numbers);
/* Find the two bodies, one of each list, that are nearest to each other: write their distance (m),
 * negative if they penetrate each other, and which they are; return DFB_NOTHING, with limit as
 * distance, if none are nearer than that. */
DFB_API int dfb_clearance(dfb_world *world, int count, const int *bodies, int other_count,
                          const int *others, double limit, double *distance, int *a, int *b);

/* Rays and sweeps */
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
/* Move a shape that is neither a plane nor a union straight from one pose to another (7 doubles
 * each, at least 1e-9 m apart), turning evenly: write the first body that it touches, the
 * passed_count ones aside, and 7 doubles as for rays.  Return DFB_NOTHING if there is none. */
DFB_API int dfb_sweep(dfb_world *world, const dfb_shape *shape, const double *from,
                      const double *to, int passed_count, const int *passed, int *body,
                      double *hit);

/* Checkpoints */
/* Return the number of doubles of a checkpoint. */
DFB_API int dfb_checkpoint_size(dfb_world *world);
/* Write a checkpoint, to an output of length doubles.  It holds whatever later steps depend on: all
 * states, sleep, motors, attachments, ignored collisions.  What Bullet would remember beyond
 * that, as contacts, the world forgets, so that it goes on with the same bits as a world to which
 * the checkpoint is restored. */
DFB_API int dfb_checkpoint_make(dfb_world *world, double *checkpoint, int length);
/* Restore a checkpoint of this world or of one with equal bodies and joints, made in the same
 * order; return DFB_BAD_CHECKPOINT for any other. */
DFB_API int dfb_checkpoint_restore(dfb_world *world, const double *checkpoint, int length);

/* Mechanisms: trees of links moved by forward kinematics, robots.  A link hangs on a joint, which
 * has the link's index; positions are one double (m or rad) for each joint. */
/* Return a mechanism of count links, parents first.  Each has 4 integers: parent or -1; type, 0
 * fixed, 1 turning, 2 sliding; the joint that it mimics or -1; kinematic body or -1; and 14
 * doubles: pose of the joint in the frame of the parent, unit axis, lower and upper limit (may be
 * infinite), multiplier and offset of the mimicked position. */
DFB_API int dfb_mechanism_new(dfb_world *world, int count, const int *integers,
                              const double *numbers);
/* Move the links' bodies to where base, a pose, and positions put them; with teleport 1 at rest,
 * and with them what is attached to them. */
DFB_API int dfb_mechanism_pose(dfb_world *world, int mechanism, const double *base,
                               const double *positions, int teleport);
/* Write where the base, a pose, and the joints, one position each, were moved to last. */
DFB_API int dfb_mechanism_read(dfb_world *world, int mechanism, double *base, double *positions);
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

/* Motions of a mechanism */
/* Begin a motion that takes the joints from start to goal (joints that are not at start are put
 * there first, at rest; start NULL: where they are; goal NULL: start), straight or on a smooth
 * curve through via_count positions in between, one set after the other, and, with base_moves 1,
 * the base along bases.  Without fast each step steps the world; with fast 1 steps that can
 * affect nothing but held bodies are skipped.  A step in which a watched body, of a link or
 * attached to one, would come as near as contact_distance (m, not negative) to an obstacle ends
 * the motion before it. */
DFB_API int dfb_motion_begin(dfb_world *world, int mechanism, const double *start,
                             const double *goal, int via_count, const double *via, int base_moves,
                             int fast, double contact_distance, int watched_count,
                             const int *watched, int obstacle_count, const int *obstacles);
/* Do up to count steps more of the motion begun last: bases has a pose, fractions the part of the
 * way of the joints after each step; either may be NULL for what does not change.  Return how many
 * were done before a contact; write the two bodies of the contact, or -1. */
DFB_API int dfb_motion_continue(dfb_world *world, int mechanism, int count, const double *bases,
                                const double *fractions, int *bodies);

/* Clearances of mechanisms: nothing is moved.  A body of a link, or one attached to it, is where
 * base and positions would put it, any other one where it is.  Pairs that ignore their collision
 * do not count. */
/* Find the two bodies, one of watched and one of obstacles, that are nearest to each other: write
 * their distance (m, 0 if they penetrate each other) and them.  Return DFB_NOTHING if none are
 * nearer than limit.  The search ends with the first two that penetrate each other. */
DFB_API int dfb_mechanism_clearance(dfb_world *world, int mechanism, const double *base,
                                    const double *positions, int watched_count,
                                    const int *watched, int obstacle_count, const int *obstacles,
                                    double limit, double *distance, int *bodies);
/* Find where on the straight way of the joints from start to goal two such bodies first come as
 * near as contact_distance: write the fraction of the way and them, or return DFB_NOTHING.  Two
 * that are so near at the start already may come 1 mm closer.  No joint may go farther than 1000 (m
 * or rad). */
DFB_API int dfb_path_contact(dfb_world *world, int mechanism, const double *base,
                             const double *start, const double *goal, int watched_count,
                             const int *watched, int obstacle_count, const int *obstacles,
                             double contact_distance, double *fraction, int *bodies);
#ifdef __cplusplus
}
#endif
#endif
