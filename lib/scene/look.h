/* Declares how the particles of a system look. */
#ifndef KILN_SCENE_LOOK_H
#define KILN_SCENE_LOOK_H

#include <stdbool.h>
#include <stdint.h>

#include "asset/geometry/mesh_library.h"
#include "option/values.h"
#include "scene/pattern.h"
#include "shared/draw_layout.h"
#include "shared/particle.h"

enum kiln_blend {
    KILN_BLEND_ALPHA, /* premultiplied "over": smoke */
    KILN_BLEND_ADD,   /* adds light and covers nothing: fire */
};

enum kiln_shape {
    KILN_SHAPE_BILLBOARD,
    KILN_SHAPE_POINT,  /* a disc or a square without a texture */
    KILN_SHAPE_LINE,   /* from the particle back along its path */
    KILN_SHAPE_SPHERE, /* opaque, lit like the backdrop */
    KILN_SHAPE_MESH,   /* a mesh from a file, opaque, lit like the backdrop */
    KILN_SHAPE_RIBBON, /* strips through the particles in the order of their births */
};

/* Says what a ribbon turns its face to. */
enum kiln_ribbon_facing {
    KILN_RIBBON_CAMERA,
    KILN_RIBBON_NORMAL, /* the look's axis */
};

enum { KILN_RIBBON_MOST_SMOOTH = 16 };

/* How ribbons look. */
struct kiln_look_ribbon {
    enum kiln_ribbon_facing facing;
    uint32_t smooth;  /* parts that each segment is drawn as; 1: straight segments */
    double texture_m; /* length of the texture along the ribbon; 0: it is stretched over it */
    double taper[2];  /* factors on the width at the older and at the younger end */
    double gap_m;     /* longer segments are not drawn; 0: all are */
};

/* How a mesh that is a particle is oriented. Its own z axis is ahead and y is up. */
enum kiln_orient {
    KILN_ORIENT_VELOCITY, /* ahead is the velocity, up near to the world's */
    KILN_ORIENT_SPIN,     /* turned by collisions, or about a random axis */
    KILN_ORIENT_UPRIGHT,  /* turned about the world's up */
};

/* The mesh that particles of a system are drawn as. "follows": filled when shape is mesh. */
struct kiln_look_mesh {
    const char *file; /* an absolute path; NULL: none */
    enum kiln_orient orient;
    const struct kiln_mesh *shown; /* follows: the content of the file */
    /* follows: radius, in sizes, of a sphere whose shadow is as large as the mesh's mean shadow */
    float shade;
};

/* How a billboard stands to the camera (Heinz 2019, 2.1.1). */
enum kiln_facing {
    KILN_FACING_SCREEN,    /* parallel to the picture, up is the picture's */
    KILN_FACING_VIEWPLANE, /* parallel to the picture, up is the world's */
    KILN_FACING_VIEWPOINT, /* turned to the eye, up is the world's */
    KILN_FACING_AXIAL,     /* turned to the eye about an axis, which is up */
    KILN_FACING_VELOCITY,  /* parallel to the picture, up is the direction of flight */
    KILN_FACING_SURFACE,   /* in the plane of the surface that the particle rests on */
    KILN_FACING_NORMAL,    /* in a plane of the world */
};

struct kiln_look_facing {
    enum kiln_facing way;
    struct kiln_value3 normal; /* of KILN_FACING_NORMAL; need not be normalised, not zero */
};

enum kiln_line_to {
    KILN_LINE_VELOCITY, /* back along the velocity by speed * stretch */
    KILN_LINE_PREVIOUS, /* to where the particle was a frame ago */
};

enum kiln_soft_formula {
    KILN_SOFT_CLAMPED, /* clamp((scene - particle) * s, 0, 1) */
    KILN_SOFT_LITERAL, /* abs(scene - distance of the particle) * s, as printed (Heinz 2019, 3.3) */
};

enum kiln_motion_green {
    KILN_GREEN_AUTO, /* as the layout of the flipbook says; up without one */
    KILN_GREEN_UP,
    KILN_GREEN_DOWN,
};

/* Holds the motion that full red and full green of a motion file stand for, in edges of a cell. */
struct kiln_motion_scale {
    bool given; /* false: as the layout of the flipbook says; 1 without one */
    double right, up;
};

struct kiln_look {
    const char *atlas[KILN_MAX_TEXTURES]; /* "builtin:NAME" or absolute file paths, of which each */
    uint32_t atlas_count;                 /* particle gets one */
    union {                               /* cells of each atlas; an option fills both at once */
        uint32_t cells[2];
        struct {
            uint32_t columns, rows;
        };
    };
    const char *motion; /* "none", "auto" (of built-in atlases) or an absolute file path */
    enum kiln_motion_green motion_green;
    struct kiln_motion_scale motion_scale;
    /* follow from the above and the layout: the motion to the right and up, in edges of a cell,
     * that the file's full red and green stand for; the layout's absolute path, or NULL: none was
     * read */
    float motion_full[2];
    const char *motion_layout;
    enum kiln_blend blend;
    struct kiln_value size;          /* m: edge of the billboard */
    struct kiln_range scale;         /* factor on size, random for each particle */
    struct kiln_value width, height; /* of a billboard: factors on size, across and along */
    enum kiln_shape shape;
    struct kiln_look_facing facing; /* of a billboard: how it faces the camera */
    struct kiln_value3 axis;      /* axis of an axial billboard; need not be normalised, not zero */
    struct kiln_value point_size; /* px: diameter of a point; 0: size, in metres */
    bool point_round;             /* true: a disc; false: a square */
    struct kiln_value line_width; /* px */
    enum kiln_line_to line_to;
    struct kiln_look_sphere sphere;
    struct kiln_look_mesh mesh;
    struct kiln_look_ribbon ribbon;
    /* s: a billboard is longer along the velocity by speed * stretch; 0: square */
    struct kiln_value stretch;
    bool stretch_dims;                   /* of a billboard: it is as much fainter as longer */
    struct kiln_range rotation;          /* rad at birth */
    struct kiln_range spin;              /* rad/s; the sign is random for each particle */
    struct kiln_value cycles;            /* passes through the atlas in one life */
    bool random_start;                   /* each particle starts at a cell of its own */
    struct kiln_value3 color;            /* linear; multiplies the atlas or the blackbody colour */
    struct kiln_value opacity;           /* 0..1 */
    struct kiln_value temperature;       /* K: blackbody colour; 0: none */
    struct kiln_value intensity;         /* factor on emitted light */
    struct kiln_value fade_in, fade_out; /* parts of the life over which opacity rises and falls */
    struct kiln_value soft;              /* 1/m: softness by equation 3.3; 0: hard edges */
    enum kiln_soft_formula soft_formula;
    struct kiln_value thickness; /* in units of size, for KILN_COMPOSE_OIT */
    struct kiln_value near_fade; /* m: fades over this distance to the near plane */
    struct kiln_value3 bloom;    /* weights of equation 3.2, per channel */
    struct kiln_value lit;       /* 0 unlit .. 1 lit by sun, sky and lights */
    struct kiln_value shadow;    /* of particles that cover: factor on the shadow that they cast */
    struct kiln_value3 light;    /* factor on the light that they shed on other objects; 0: none */
    uint32_t light_count;        /* number of point lights for that light */
    bool light_shadow;           /* objects hide them */
};

/* Returns whether a colour of a look is that of the mesh or image where a particle was born. */
static inline bool kiln_color_is_source(const struct kiln_value3 *color)
{
    return color->x.count == 0 && color->x.constant == KILN_VALUE_BY_WORD;
}

static inline bool kiln_look_color_is_source(const struct kiln_look *look)
{
    return kiln_color_is_source(&look->color);
}

/* Returns whether particles are drawn on the surfaces that they rest on. */
static inline bool kiln_look_lies(const struct kiln_look *look)
{
    return look->shape == KILN_SHAPE_BILLBOARD && look->facing.way == KILN_FACING_SURFACE;
}

/* Returns whether billboards are not as long as they are wide, apart from a stretch. */
static inline bool kiln_look_is_formed(const struct kiln_look *look)
{
    const struct kiln_value *w = &look->width, *h = &look->height;
    return look->shape == KILN_SHAPE_BILLBOARD &&
           (w->count > 0 || h->count > 0 || w->constant != 1.0f || h->constant != 1.0f);
}

/* Returns whether particles show a texture. */
static inline bool kiln_look_has_texture(const struct kiln_look *look)
{
    return look->shape == KILN_SHAPE_BILLBOARD || look->shape == KILN_SHAPE_RIBBON;
}

/* Returns whether particles are solid, with other particles in front of or behind them. */
static inline bool kiln_look_is_opaque(const struct kiln_look *look)
{
    return look->shape == KILN_SHAPE_SPHERE || look->shape == KILN_SHAPE_MESH;
}

#endif
