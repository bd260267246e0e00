// The GLSL half of the dialect in which shared texts are written (the C++ half is shared/dialect.h).
#define NPH_FN
#define NPH_CONST const
#define NPH_OUT(type) out type
#define NPH_INOUT(type) inout type
