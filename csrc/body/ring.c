#include "body/ring.h"

/* Moments on a ring at rest are about the apex. */
static void place_at_rest(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose)
{
  (void)m;
  (void)drive;
  *pose = (trb_ring_pose){.axis = {0, 0, 1}};
}

static void place_as_prescribed(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose)
{
  (void)m;
  *pose = drive->ring;
}

/* About the apex, as a ring at rest. */
static void place_turning(const trb_model *m, const trb_drive *drive, trb_ring_pose *pose)
{
  (void)m;
  *pose = (trb_ring_pose){.axis = {0, 0, 1}, .omega = {0, 0, drive->carried_speed}, .angle = drive->carried_angle};
}

static trb_drive_power power_of_turning(const trb_ring_pose *ring, const trb_drive *drive, const trb_wrench *on_ring)
{
  (void)drive;
  return (trb_drive_power){-trb_dot(on_ring->moment, ring->omega), 0.0};
}

static trb_drive_power power_of_drive(const trb_ring_pose *ring, const trb_drive *drive, const trb_wrench *on_ring)
{
  const double shaft = -trb_dot(on_ring->moment, ring->axis) * drive->shaft_speed;
  return (trb_drive_power){shaft, -trb_dot(on_ring->force, ring->velocity) - trb_dot(on_ring->moment, ring->omega) - shaft};
}

const trb_body_kind trb_ring_at_rest = {.name = "ring at rest", .rests = 1, .place = place_at_rest};
const trb_body_kind trb_ring_prescribed = {.name = "ring as prescribed", .place = place_as_prescribed, .power = power_of_drive};
const trb_body_kind trb_ring_turning = {.name = "ring that turns as prescribed", .place = place_turning, .power = power_of_turning};
const trb_body_kind trb_fluid_at_rest = {.name = "fluid at rest", .rests = 1};
