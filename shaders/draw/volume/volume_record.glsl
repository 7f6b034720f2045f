/* Records how a ray is dimmed and lit on its way, and makes profiles of it, as
 * lib/draw/volume/volume_record.h does on the host. The eight rays of a packet share the places of
 * their profile, which they choose together.
 *
 * A ray records the light so far every `stride` steps, from the first step on that adds any. Each
 * time that there are too many records, every second one is dropped. Records lie at multiples of
 * the stride, so those of all rays of a packet meet at multiples of the greatest stride. */
const uint RECORDS = 64u, TRIES = 8u; /* most records of a ray; most tries with greater errors */

/* How far a profile may lie from the records: less than on the host, since records are rounded. */
const float DEPTH_ERROR = 0.005, LIGHT_ERROR = 0.004, ALL_ERROR = 0.001;

uvec4 records[RECORDS]; /* numbers of a place, as profiles have them */
uint record_count = 0u, record_first = 0u, record_stride = 1u;

/* Returns the upper halves of floats that are not negative, rounded. */
uvec3 halves_of(vec3 x)
{
    return (floatBitsToUint(x) + 0x8000u) >> 16;
}

uvec4 pack_node(float depth, vec3 smoke, vec3 flame)
{
    uvec3 s = halves_of(smoke), f = halves_of(flame);
    uint d = uint(min(depth / VOLUME_DEPTH_UNIT + 0.5, 65535.0));
    return uvec4(d | s.x << 16, s.y | s.z << 16, f.x | f.y << 16, f.z);
}

void unpack_node(uvec4 node, out float depth, out vec3 smoke, out vec3 flame)
{
    uvec4 low = node << 16, high = node & 0xffff0000u;
    depth = float(node.x & 0xffffu) * VOLUME_DEPTH_UNIT;
    smoke = uintBitsToFloat(uvec3(high.x, low.y, high.y));
    flame = uintBitsToFloat(uvec3(low.z, high.z, low.w));
}

/* Drops every second record, so that those at multiples of twice the stride stay. The first record
 * is empty. */
void halve_records()
{
    uint odd = record_first / record_stride & 1u;
    record_count = (RECORDS - 1u + odd) / 2u + 1u;
    for (uint i = 1u; i < record_count; i++)
        records[i] = records[2u * i - odd];
    record_first -= odd * record_stride;
    record_stride *= 2u;
}

/* Adds records up to the begin of a step; nothing has been seen since the last one of them. */
void record_until(ray r, uint number)
{
    uvec4 now = pack_node(r.depth, r.smoke, r.flame);
    if (record_count == 0u)
        record_first = number;
    while (record_first + record_count * record_stride <= number) {
        if (record_count == RECORDS)
            halve_records();
        else
            records[record_count++] = now;
    }
}

/* Adds a last record behind all that was seen. number: the end of the last step that was drawn. */
void record_end(ray r, uint number)
{
    record_until(r, number);
    uint last = record_first + (record_count - 1u) * record_stride;
    if (last < number)
        record_until(r, last + record_stride);
}

/* ---- packets --------------------------------------------------------------------------------- */

const uint PACKETS = 8u; /* of a work group */
shared uint packet_first[PACKETS], packet_last[PACKETS], packet_stride[PACKETS];
shared uint packet_votes[2][PACKETS], packet_at[PACKETS], group_tries;

/* The places of a packet: `count` of them from `first` on. */
struct packet_places {
    uint first, stride, count;
};

uvec4 record_at(packet_places p, uint i)
{
    uint place = p.first + i * p.stride;
    if (record_count == 0u || place <= record_first)
        return uvec4(0u);
    return records[min((place - record_first) / record_stride, record_count - 1u)];
}

/* Returns optical depth, and luminance of smoke and of flames, at a place. */
vec3 curves_at(packet_places p, uint i)
{
    float depth;
    vec3 smoke, flame, weights = vec3(0.25, 0.5, 0.25);
    unpack_node(record_at(p, i), depth, smoke, flame);
    return vec3(depth, dot(smoke, weights), dot(flame, weights));
}

/* The slopes that lines from a place may have. */
struct slope_range {
    vec3 least, most;
};

slope_range any_slopes()
{
    return slope_range(vec3(-1e30), vec3(1e30));
}

/* Narrows slopes by a record. error: a factor on the errors that are allowed. Returns whether none is
 * left. */
bool narrow_slopes(inout slope_range s, packet_places p, float error, vec3 all, uint from,
                   uint to)
{
    vec3 here = curves_at(p, to), rise = here - curves_at(p, from);
    vec3 most = error * vec3(DEPTH_ERROR, LIGHT_ERROR * here.yz + ALL_ERROR * all.yz);
    float inverse = 1.0 / float(to - from);
    s.least = max(s.least, (rise - most) * inverse);
    s.most = min(s.most, (rise + most) * inverse);
    return any(greaterThan(s.least, s.most));
}

void choose(inout uvec2 chosen, uint i)
{
    if (i < 32u)
        chosen.x |= 1u << i;
    else
        chosen.y |= 1u << (i - 32u);
}

bool is_chosen(uvec2 chosen, uint i)
{
    return ((i < 32u ? chosen.x >> i : chosen.y >> (i - 32u)) & 1u) != 0u;
}

/* Finds the places of the records of a packet. Its count is 0 if no ray of it met gas. */
packet_places join_records(uint packet)
{
    if (gl_LocalInvocationIndex % uint(VOLUME_PACKET) == 0u) {
        packet_first[packet] = 0xffffffffu;
        packet_last[packet] = 0u;
        packet_stride[packet] = 1u;
        packet_votes[0][packet] = packet_votes[1][packet] = group_tries = 0u;
    }
    barrier();
    if (record_count > 0u) {
        atomicMin(packet_first[packet], record_first);
        atomicMax(packet_last[packet], record_first + (record_count - 1u) * record_stride);
        atomicMax(packet_stride[packet], record_stride);
    }
    barrier();
    uint first = packet_first[packet], last = packet_last[packet], stride = packet_stride[packet];
    if (first > last)
        return packet_places(0u, 1u, 0u);
    while ((last - first / stride * stride + stride - 1u) / stride >= RECORDS)
        stride *= 2u;
    first = first / stride * stride;
    return packet_places(first, stride, (last - first + stride - 1u) / stride + 1u);
}

uint count_of(uvec2 chosen)
{
    return uint(bitCount(chosen.x) + bitCount(chosen.y));
}

/* Chooses the places between which straight lines stay close to all records of a packet's rays.
 * error: a factor on the errors that are allowed; tries: calls before this one. */
uvec2 try_places(uint packet, packet_places p, float error, uint tries)
{
    uvec2 chosen = uvec2(1u, 0u);
    uint from = 0u, last = max(p.count, 1u) - 1u;
    vec3 all = curves_at(p, last);
    slope_range slopes = any_slopes();
    for (uint i = 1u; i < RECORDS; i++) {
        uint vote = tries * RECORDS + i; /* more than all votes before */
        if (i <= last && narrow_slopes(slopes, p, error, all, from, i))
            atomicMax(packet_votes[i % 2u][packet], vote);
        barrier();
        if (packet_votes[i % 2u][packet] != vote)
            continue;
        from = i - 1u > from ? i - 1u : i;
        choose(chosen, from);
        slopes = any_slopes();
        if (from < i)
            narrow_slopes(slopes, p, error, all, from, i);
    }
    choose(chosen, last);
    return chosen;
}

/* Chooses the places of the profiles of a packet, at most VOLUME_NODES: by greater errors while they
 * are too many, and in the end every second one. All packets of the group take as many turns. */
uvec2 choose_places(uint packet, packet_places p)
{
    float error = 1.0;
    uvec2 chosen = try_places(packet, p, error, 0u);
    for (uint tries = 1u; tries <= TRIES; tries++) {
        bool many = count_of(chosen) > uint(VOLUME_NODES);
        if (many)
            atomicMax(group_tries, tries);
        barrier();
        if (group_tries != tries)
            return chosen;
        error *= 1.4;
        uvec2 fewer = try_places(packet, p, error, tries);
        chosen = many ? fewer : chosen;
    }
    if (count_of(chosen) > uint(VOLUME_NODES)) {
        chosen = uvec2(0u);
        for (uint i = 0u; i + 2u < p.count; i += 2u)
            choose(chosen, i);
        choose(chosen, p.count - 1u);
    }
    return chosen;
}
