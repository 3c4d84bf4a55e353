#include "robotic_arm_table.h"

#include <algorithm>
#include <initializer_list>

namespace musclesim::robotic_arm {
namespace {

constexpr const char* environment = nullptr;

constexpr OperationRow rotate(const char* primitive, double angle_deg, char axis) {
  return {.kind = Kind::rotate, .primitive = primitive, .axis = axis, .angle_deg = angle_deg};
}

constexpr OperationRow fix(const char* primitive) {
  return {.kind = Kind::fix, .primitive = primitive};
}

constexpr OperationRow composite(const char* parent, std::initializer_list<const char*> parts) {
  OperationRow row{.kind = Kind::composite, .primitive = parent};
  std::copy(parts.begin(), parts.end(), row.parts.begin());
  return row;
}

constexpr OperationRow ball(const char* primitive, const char* other, const Triple& anchor_mm) {
  return {.kind = Kind::ball, .primitive = primitive, .other = other, .anchor_mm = anchor_mm};
}

constexpr OperationRow hinge(const char* primitive, const char* other, const Triple& anchor_mm, char axis, double low_deg,
                             double high_deg) {
  return {.kind = Kind::hinge,
          .primitive = primitive,
          .other = other,
          .anchor_mm = anchor_mm,
          .axis = axis,
          .low_deg = low_deg,
          .high_deg = high_deg};
}

// clang-format off
constexpr std::array<PrimitiveRow, 33> primitive_rows{{
    // name, shape, centre (mm), mass (g), size (mm)
    {"rib_1_2",          Shape::box,             {-20, 425, 110},   10,  {41.513878189, 30, 5}},
    {"rib_1_2_rest",     Shape::box,             {-55, 425, 100},   10,  {37.569390943, 30, 5}},
    {"rib_3_4",          Shape::box,             {-25, 385, 125},   10,  {51.666666667, 30, 5}},
    {"rib_3_4_rest",     Shape::box,             {-70, 385, 110},   10,  {51.666666667, 30, 5}},
    {"rib_5_6",          Shape::box,             {-30, 345, 140},   10,  {61.810249676, 30, 5}},
    {"rib_5_6_rest_1",   Shape::box,             {-90, 345, 115},   10,  {79.912746435, 30, 5}},
    {"rib_5_6_rest_2",   Shape::box,             {-125, 345, 40},   10,  {102.309005887, 30, 5}},
    {"rib_7_8",          Shape::box,             {-30, 305, 155},   10,  {61.878675581, 30, 5}},
    {"rib_7_8_rest_1",   Shape::box,             {-100, 305, 120},  10,  {108.180133708, 30, 5}},
    {"rib_7_8_rest_2",   Shape::box,             {-145, 305, 35},   10,  {102.377431792, 30, 5}},
    {"rib_9_10",         Shape::box,             {-30, 265, 170},   10,  {61.878675581, 30, 5}},
    {"rib_9_10_rest_1",  Shape::box,             {-100, 265, 135},  10,  {108.180133708, 30, 5}},
    {"rib_9_10_rest_2",  Shape::box,             {-145, 265, 50},   10,  {102.377431792, 30, 5}},
    {"rib_11_12",        Shape::box,             {-30, 225, 170},   10,  {61.810249676, 30, 5}},
    {"rib_11_12_rest_1", Shape::box,             {-90, 225, 145},   10,  {79.912746435, 30, 5}},
    {"rib_11_12_rest_2", Shape::box,             {-125, 225, 80},   10,  {82.432827159, 30, 5}},
    {"scapula",          Shape::box,             {-190, 330, -120}, 80,  {70, 170, 10}},
    {"scapula_rest_1",   Shape::box,             {-225, 330, -120}, 80,  {79.07526069, 150.489544975, 10}},
    {"scapula_rest_2",   Shape::box,             {-255, 410, -120}, 80,  {30, 80, 5}},
    {"humerus",          Shape::capped_cylinder, {-210, 260, 0},    200, {13, 300, 0}},
    {"shoulder",         Shape::sphere,          {-210, 410, 0},    30,  {20, 0, 0}},
    {"elbow",            Shape::sphere,          {-210, 110, 0},    30,  {20, 0, 0}},
    {"radius_head",      Shape::capped_cylinder, {-210, -150, 0},   20,  {6, 40, 0}},
    {"radius",           Shape::capped_cylinder, {-230, -35, 0},    100, {6, 230, 0}},
    {"ulna_head",        Shape::capped_cylinder, {-210, 80, 0},     20,  {6, 40, 0}},
    {"ulna",             Shape::capped_cylinder, {-190, -35, 0},    100, {6, 230, 0}},
    {"ulna_rest",        Shape::box,             {-210, 80, -30},   20,  {16, 8, 60}},
    {"pollex",           Shape::box,             {-250, -240.5, 0}, 10,  {22, 105, 14}},
    {"index",            Shape::box,             {-225, -257.5, 0}, 10,  {16, 185, 14}},
    {"medius",           Shape::box,             {-205, -267.5, 0}, 10,  {16, 205, 14}},
    {"medius_rest",      Shape::box,             {-205, -169, 0},   10,  {16, 8, 70}},
    {"anularius",        Shape::box,             {-185, -257.5, 0}, 10,  {16, 185, 14}},
    {"minimus",          Shape::box,             {-165, -255, 0},   10,  {16, 140, 14}},
}};

constexpr std::array<OperationRow, 52> operation_rows{{
    rotate("rib_1_2_rest", -33.690067526, 'y'),
    composite("rib_1_2", {"rib_1_2", "rib_1_2_rest"}),
    rotate("rib_1_2", -10, 'x'),
    rotate("rib_1_2", -2, 'z'),
    fix("rib_1_2"),
    rotate("rib_3_4_rest", -36.869897646, 'y'),
    composite("rib_3_4", {"rib_3_4", "rib_3_4_rest"}),
    rotate("rib_3_4", -10, 'x'),
    rotate("rib_3_4", -2, 'z'),
    fix("rib_3_4"),
    rotate("rib_5_6_rest_1", -39.805571092, 'y'),
    rotate("rib_5_6_rest_2", -84.289406863, 'y'),
    composite("rib_5_6_rest_2", {"rib_5_6", "rib_5_6_rest_1", "rib_5_6_rest_2"}),
    rotate("rib_5_6", -6, 'x'),
    fix("rib_5_6"),
    rotate("rib_7_8_rest_1", -41.185925166, 'y'),
    rotate("rib_7_8_rest_2", -84.289406863, 'y'),
    composite("rib_7_8_rest_2", {"rib_7_8", "rib_7_8_rest_1", "rib_7_8_rest_2"}),
    rotate("rib_7_8", -5, 'x'),
    fix("rib_7_8"),
    rotate("rib_9_10_rest_1", -41.185925166, 'y'),
    rotate("rib_9_10_rest_2", -84.289406863, 'y'),
    composite("rib_9_10_rest_2", {"rib_9_10", "rib_9_10_rest_1", "rib_9_10_rest_2"}),
    rotate("rib_9_10", -5, 'x'),
    rotate("rib_9_10", 1, 'z'),
    fix("rib_9_10"),
    rotate("rib_11_12_rest_1", -39.805571092, 'y'),
    rotate("rib_11_12_rest_2", -82.874983651, 'y'),
    composite("rib_11_12_rest_2", {"rib_11_12", "rib_11_12_rest_1", "rib_11_12_rest_2"}),
    rotate("rib_11_12", -2, 'x'),
    rotate("rib_11_12", 2, 'z'),
    fix("rib_11_12"),
    rotate("scapula_rest_1", 27.71983911, 'z'),
    rotate("scapula_rest_2", 27.71983911, 'z'),
    composite("scapula_rest_2", {"scapula", "scapula_rest_1", "scapula_rest_2"}),
    rotate("scapula", 20, 'z'),
    rotate("scapula", 60, 'y'),
    fix("scapula"),
    rotate("humerus", 90, 'x'),
    composite("elbow", {"humerus", "shoulder", "elbow"}),
    ball("humerus", environment, {-210, 410, 0}),
    rotate("radius_head", 90, 'y'),
    rotate("radius", 90, 'x'),
    composite("radius", {"radius", "radius_head"}),
    rotate("ulna_head", 90, 'y'),
    rotate("ulna", 90, 'x'),
    composite("ulna_rest", {"ulna_head", "ulna", "ulna_rest"}),
    ball("radius", "ulna", {-230, 80, 0}),
    ball("radius", "ulna", {-190, -150, 0}),
    hinge("ulna", "elbow", {-210, 110, 0}, 'x', -90, 0),
    composite("minimus", {"pollex", "index", "medius", "medius_rest", "anularius", "minimus"}),
    hinge("pollex", "radius", {-190, -150, 0}, 'x', -60, 60),
}};

constexpr std::array<MuscleRow, 30> muscle_rows{{
    // The ten muscles of the published program.
    {.color_name = "gray", .cap_rgb = {0.75, 0.75, 0.75},  // 0
     .start_mm = {-197, 310, 0}, .start_control_mm = {-137, 310, 20},
     .end_control_mm = {-135, 425, 130}, .end_mm = {-55, 425, 100},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "rib_1_2"},
    {.color_name = "pink", .cap_rgb = {1, 0.73, 0.8},  // 1
     .start_mm = {-197, 295, 0}, .start_control_mm = {-157, 295, 50},
     .end_control_mm = {-200, 225, 90}, .end_mm = {-120, 225, 120},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "rib_11_12"},
    {.color_name = "brown", .cap_rgb = {0.73, 0.09, 0.15},  // 2
     .start_mm = {-223, 360, 0}, .start_control_mm = {-293, 410, -40},
     .end_control_mm = {-280, 360, -100}, .end_mm = {-230, 360, -120},
     .minimum_length_mm = 75, .maximum_length_mm = 200,
     .connect_start_to = "humerus", .connect_end_to = "scapula"},
    {.color_name = "red", .cap_rgb = {1, 0, 0},  // 3
     .start_mm = {-223, 210, 0}, .start_control_mm = {-253, 230, 0},
     .end_control_mm = {-194, 405, -10}, .end_mm = {-254, 415, -60},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "scapula"},
    {.color_name = "orange", .cap_rgb = {1, 0.63, 0},  // 4
     .start_mm = {-210, 260, -13}, .start_control_mm = {-210, 220, -43},
     .end_control_mm = {-210, 164, -51}, .end_mm = {-210, 84, -51},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "ulna_rest"},
    {.color_name = "yellow", .cap_rgb = {0.99, 1, 0},  // 5
     .start_mm = {-210, 260, 13}, .start_control_mm = {-210, 240, 33},
     .end_control_mm = {-190, 30, 54}, .end_mm = {-190, 20, 6},
     .minimum_length_mm = 90, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "ulna"},
    {.color_name = "green", .cap_rgb = {0, 1, 0},  // 6
     .start_mm = {-224.142135624, 110, -14.142135624}, .start_control_mm = {-240, 90, -30},
     .end_control_mm = {-230, -15, -46}, .end_mm = {-230, -15, -6},
     .minimum_length_mm = 60, .maximum_length_mm = 200,
     .connect_start_to = "elbow", .connect_end_to = "radius"},
    {.color_name = "aquamarine", .cap_rgb = {0.25, 1, 0.83},  // 7
     .start_mm = {-210, 150, 13}, .start_control_mm = {-250, 130, 53},
     .end_control_mm = {-230, -95, 26}, .end_mm = {-230, -95, 6},
     .minimum_length_mm = 60, .maximum_length_mm = 350,
     .connect_start_to = "elbow", .connect_end_to = "radius"},
    {.color_name = "blue", .cap_rgb = {0.1, 0, 1},  // 8
     .start_mm = {-190, -35, 6}, .start_control_mm = {-190, -35, 46},
     .end_control_mm = {-205, -125, 35}, .end_mm = {-205, -165, 25},
     .minimum_length_mm = 60, .maximum_length_mm = 200,
     .connect_start_to = "ulna", .connect_end_to = "medius_rest"},
    {.color_name = "purple", .cap_rgb = {0.73, 0, 0.96},  // 9
     .start_mm = {-190, -35, -6}, .start_control_mm = {-190, -35, -46},
     .end_control_mm = {-205, -125, -35}, .end_mm = {-205, -165, -25},
     .minimum_length_mm = 60, .maximum_length_mm = 200,
     .connect_start_to = "ulna", .connect_end_to = "medius_rest"},

    // Ten more with the roles of the first ten: muscle 10 + k spans the joints that muscle k spans.
    {.color_name = "olive", .cap_rgb = {0.5, 0.5, 0},  // 10
     .start_mm = {-201.6, 346.8, 10}, .start_control_mm = {-159, 346, 43},
     .end_control_mm = {-132, 392, 159}, .end_mm = {-52.5, 395.3, 124.3},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "rib_3_4"},
    {.color_name = "rose", .cap_rgb = {1, 0, 0.5},  // 11
     .start_mm = {-203.5, 278.4, 11.3}, .start_control_mm = {-192, 280, 78},
     .end_control_mm = {-171, 273, 163}, .end_mm = {-101.5, 272.8, 136.5},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "rib_9_10"},
    {.color_name = "sienna", .cap_rgb = {0.63, 0.32, 0.18},  // 12
     .start_mm = {-216.3, 313.5, -11.4}, .start_control_mm = {-260, 313, -49},
     .end_control_mm = {-269, 273, -125}, .end_mm = {-219.5, 274.9, -136.7},
     .minimum_length_mm = 75, .maximum_length_mm = 200,
     .connect_start_to = "humerus", .connect_end_to = "scapula"},
    {.color_name = "salmon", .cap_rgb = {0.98, 0.5, 0.45},  // 13
     .start_mm = {-220.5, 256.9, 7.6}, .start_control_mm = {-275, 277, 33},
     .end_control_mm = {-308, 430, -8}, .end_mm = {-258.3, 430.2, -64.5},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "scapula"},
    {.color_name = "chocolate", .cap_rgb = {0.82, 0.41, 0.12},  // 14
     .start_mm = {-213.4, 220.9, -12.6}, .start_control_mm = {-248, 181, -54},
     .end_control_mm = {-265, 132, -86}, .end_mm = {-219.8, 76.4, -57},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "ulna_rest"},
    {.color_name = "gold", .cap_rgb = {1, 0.84, 0},  // 15
     .start_mm = {-197.2, 270.8, 2.4}, .start_control_mm = {-165, 245, 26},
     .end_control_mm = {-148, 79, 34}, .end_mm = {-187.9, 48.2, 5.6},
     .minimum_length_mm = 90, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "ulna"},
    {.color_name = "forest", .cap_rgb = {0.13, 0.55, 0.13},  // 16
     .start_mm = {-227, 120.5, 1.3}, .start_control_mm = {-259, 104, -9},
     .end_control_mm = {-269, 5, -11}, .end_mm = {-235.6, -1.9, 2.1},
     .minimum_length_mm = 60, .maximum_length_mm = 200,
     .connect_start_to = "elbow", .connect_end_to = "radius"},
    {.color_name = "mint", .cap_rgb = {0.6, 1, 0.6},  // 17
     .start_mm = {-222.9, 176.8, -1.4}, .start_control_mm = {-269, 156, 25},
     .end_control_mm = {-260, -62, 14}, .end_mm = {-236, -61, -0.2},
     .minimum_length_mm = 60, .maximum_length_mm = 350,
     .connect_start_to = "humerus", .connect_end_to = "radius"},
    {.color_name = "azure", .cap_rgb = {0, 0.5, 1},  // 18
     .start_mm = {-184, -48.1, 0}, .start_control_mm = {-163, -59, 34},
     .end_control_mm = {-172, -137, 34}, .end_mm = {-196.7, -172.6, 8.8},
     .minimum_length_mm = 60, .maximum_length_mm = 200,
     .connect_start_to = "ulna", .connect_end_to = "medius_rest"},
    {.color_name = "plum", .cap_rgb = {0.56, 0.27, 0.52},  // 19
     .start_mm = {-186.3, -60, -4.8}, .start_control_mm = {-164, -67, -52},
     .end_control_mm = {-169, -140, -63}, .end_mm = {-195.5, -172.6, -33.3},
     .minimum_length_mm = 60, .maximum_length_mm = 200,
     .connect_start_to = "ulna", .connect_end_to = "medius_rest"},

    // And ten more: muscle 20 + k spans the joints that muscle k spans.
    {.color_name = "moss", .cap_rgb = {0.54, 0.6, 0.36},  // 20
     .start_mm = {-205.4, 327.2, 12.1}, .start_control_mm = {-166, 327, 43},
     .end_control_mm = {-127, 341, 164}, .end_mm = {-66.2, 345.2, 138.3},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "rib_5_6"},
    {.color_name = "teal", .cap_rgb = {0, 0.5, 0.5},  // 21
     .start_mm = {-205.6, 306.6, 12.2}, .start_control_mm = {-179, 308, 65},
     .end_control_mm = {-151, 312, 156}, .end_mm = {-90, 312.3, 131.5},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "rib_7_8"},
    {.color_name = "tan", .cap_rgb = {0.82, 0.71, 0.55},  // 22
     .start_mm = {-212.9, 276.2, -12.7}, .start_control_mm = {-228, 256, -50},
     .end_control_mm = {-256, 245, -140}, .end_mm = {-208.4, 256.4, -155.8},
     .minimum_length_mm = 75, .maximum_length_mm = 200,
     .connect_start_to = "humerus", .connect_end_to = "scapula"},
    {.color_name = "cobalt", .cap_rgb = {0, 0.28, 0.67},  // 23
     .start_mm = {-221.4, 194.4, -6.3}, .start_control_mm = {-260, 216, -25},
     .end_control_mm = {-296, 330, -89}, .end_mm = {-244.3, 385.3, -88.8},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "scapula"},
    {.color_name = "lime", .cap_rgb = {0.75, 1, 0},  // 24
     .start_mm = {-198.3, 238.7, -5.6}, .start_control_mm = {-170, 196, -31},
     .end_control_mm = {-162, 129, -71}, .end_mm = {-199, 76.4, -57},
     .minimum_length_mm = 75, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "ulna_rest"},
    {.color_name = "steel", .cap_rgb = {0.27, 0.51, 0.71},  // 25
     .start_mm = {-197.7, 205.8, -4.1}, .start_control_mm = {-159, 179, 7},
     .end_control_mm = {-134, 14, -1}, .end_mm = {-184.3, -16.6, -1.8},
     .minimum_length_mm = 90, .maximum_length_mm = 300,
     .connect_start_to = "humerus", .connect_end_to = "ulna"},
    {.color_name = "jade", .cap_rgb = {0, 0.66, 0.42},  // 26
     .start_mm = {-207.2, 121.9, -15.9}, .start_control_mm = {-179, 108, -45},
     .end_control_mm = {-204, 7, -41}, .end_mm = {-225.4, 8.1, -3.9},
     .minimum_length_mm = 60, .maximum_length_mm = 200,
     .connect_start_to = "elbow", .connect_end_to = "radius"},
    {.color_name = "sky", .cap_rgb = {0.53, 0.81, 0.92},  // 27
     .start_mm = {-219.8, 194.5, 8.5}, .start_control_mm = {-255, 173, 51},
     .end_control_mm = {-225, -52, 31}, .end_mm = {-227, -44.5, 5.2},
     .minimum_length_mm = 60, .maximum_length_mm = 350,
     .connect_start_to = "humerus", .connect_end_to = "radius"},
    {.color_name = "indigo", .cap_rgb = {0.29, 0, 0.51},  // 28
     .start_mm = {-194.1, -58.9, 4.4}, .start_control_mm = {-215, -63, 41},
     .end_control_mm = {-256, -131, 33}, .end_mm = {-213.4, -172.6, 9.6},
     .minimum_length_mm = 60, .maximum_length_mm = 200,
     .connect_start_to = "ulna", .connect_end_to = "medius_rest"},
    {.color_name = "lavender", .cap_rgb = {0.71, 0.49, 0.86},  // 29
     .start_mm = {-195.6, -50.1, -2.1}, .start_control_mm = {-217, -53, -34},
     .end_control_mm = {-246, -133, -25}, .end_mm = {-213.4, -172.6, -8.9},
     .minimum_length_mm = 60, .maximum_length_mm = 200,
     .connect_start_to = "ulna", .connect_end_to = "medius_rest"},
}};
// clang-format on

}  // namespace

std::span<const char* const> OperationRow::partNames() const {
  return {parts.begin(), std::find(parts.begin(), parts.end(), nullptr)};
}

std::span<const PrimitiveRow> primitives() {
  return primitive_rows;
}

std::span<const OperationRow> operations() {
  return operation_rows;
}

std::span<const MuscleRow> muscles() {
  return muscle_rows;
}

}  // namespace musclesim::robotic_arm
