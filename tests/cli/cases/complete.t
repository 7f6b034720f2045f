What may follow on a command line, for the scripts of bash, zsh and fish; tests/completion has it typed.

$ kiln complete -- re
1|word	render	render scenes into images or videos
$ kiln complete -- compl
$ kiln complete -- figure ''
1|word	sheet	draw a sheet of pictures over sweeps of parameters
1|word	triptych	draw a reference, a result and their error map
1|word	strip	draw frames of a scene or a clip in a row
$ kiln complete -- help exi
1|word	exit-codes	what each exit code means
$ kiln complete -- render --flipbook-a
1|word	--flipbook-alpha	Whether the colours of a flipbook are straight, for renderers that blend light, such as kiln, or premultiplied by alpha, as a display shows them over black.
$ kiln complete -- render --progress ''
1|word	tty	
1|word	lines	
1|word	ndjson	
1|word	none	
$ kiln complete -- render --stats=
1|word	--stats=text	
1|word	--stats=json	
$ kiln complete -- render --technique sort=cpu,
1|word	sort=cpu,simulate=cpu	host threads
1|word	sort=cpu,simulate=inplace	compute, one buffer updated in place
1|word	sort=cpu,simulate=pingpong	compute, from one buffer to another; it takes twice the memory
1|word	sort=cpu,simulate=feedback	geometry shaders and transform feedback; they take twice the memory
1|word	sort=cpu,simulate=texels	fragment shaders, from textures to textures; they take three times the memory
1|word	sort=cpu,gas=cpu	host threads, rows and bricks of cells in vectors
1|word	sort=cpu,gas=gl	compute; the gas stays in GL
1|word	sort=cpu,sort=cpu	stable radix sort, host threads
1|word	sort=cpu,sort=radix	stable radix sort, compute
1|word	sort=cpu,sort=bitonic	bitonic merge sort, compute, padded to a power of two
1|word	sort=cpu,sort=oddeven	odd-even merge sort, compute; oddeven:N spreads it over N frames
1|word	sort=cpu,backdrop=cpu	host threads, rays in vectors
1|word	sort=cpu,backdrop=gl	fragment shaders
1|word	sort=cpu,march=cpu	host threads, rays through gas in vectors
1|word	sort=cpu,march=gl	compute, a ray through gas for each pixel
1|word	sort=cpu,raster=cpu	host threads, tiles and vectors
1|word	sort=cpu,raster=geometry	points turned into billboards by a geometry shader
1|word	sort=cpu,raster=instanced	a quad for each particle, without a geometry shader
1|word	sort=cpu,raster=tiled	compute; sprites are sorted into bins, and tiles are drawn from front to back
1|word	sort=cpu,bloom=cpu	host threads, rows
1|word	sort=cpu,bloom=gl	fragment shaders
1|word	sort=cpu,composite=cpu	host threads, rows
1|word	sort=cpu,composite=gl	one fragment shader
$ kiln complete -- compare --tolerance ss
1|part	ssim=	structural similarity of luma (Wang 2004): 1 for equal pictures
$ kiln complete -- render --device ''
1|word	cpu	this machine without OpenGL
1|word	software	the first software device of OpenGL
$ kiln complete -- render -o out/
1|file:*		
$ kiln complete -- render -oout/
1|file:*	-o	
$ kiln complete -- render --output=out/
1|file:*	--output=	
$ kiln complete -- figure --check ''
1|file:*		
$ kiln complete -- test --golden ''
1|folder		
$ kiln complete -- test report ''
1|folder		
$ kiln complete -- compare a.png b.png ''
$ kiln complete -- render -- --out
1|file:*.y*ml		

Parameters of the scene on the line, and of what it includes.

$ printf 'params: {far: {number: 1}}\n' >part.yaml; printf 'kiln: 1\ninclude: part.yaml\nparams: {first: 3, other: {}}\n' >params.yaml
$ kiln complete -- check params.yaml --set par
1|part	params.	values of parameters
$ kiln complete -- check params.yaml --set params.
1|part	params.first=	a parameter
1|part	params.other=	a parameter
1|part	params.far=	a parameter
$ kiln complete -- check params.yaml --set params.f
1|part	params.first=	a parameter
1|part	params.far=	a parameter
$ kiln complete -- check params.yaml --set inc
$ kiln complete -- check params.yaml --params par
1|file:*		

Keys of scenes, with the systems of the scene on the line; other things may be wrong with it.

$ printf 'kiln: 1\nsystems:\n  blaze: {emit: {raet: 5}}\n  smoke: {}\n' >broken.yaml
$ kiln complete -- check broken.yaml --set systems.
1|part	systems.*.	every entry
1|part	systems.blaze.	a system
1|part	systems.smoke.	a system
$ kiln complete -- check broken.yaml --set systems.bl
1|part	systems.blaze.	a system
$ kiln complete -- check none.yaml --set systems.
1|part	systems.*.	every entry
$ kiln complete -- check broken.yaml --set systems.blaze.emit.ra
1|part	systems.blaze.emit.rate=	Particles born a second.
$ kiln complete -- check --set 'systems.*.collide.'
1|part	systems.*.collide.mode=	`swept` finds the point of impact on the way of a particle. `clamp` moves a particle that is inside an object to the nearest face.
1|part	systems.*.collide.randomness=	0 reflects a particle like a mirror. 1 sends it into any direction away from the surface.
1|part	systems.*.collide.slowdown=	Factor on the speed at each impact, applied after restitution, friction and randomness. 1 keeps the speed, 0 stops the particle.
1|part	systems.*.collide.restitution=	Fraction of the speed towards a surface that a particle keeps when it bounces. It counts before `randomness` turns the velocity.
1|part	systems.*.collide.friction=	Coulomb's coefficient of friction. An impact reduces the speed along the surface by at most this factor times the change of the speed towards the surface.
1|part	systems.*.collide.dies=	A particle ends at its first impact, like rain: another way to write `then: die`.
1|part	systems.*.collide.then=	What an impact does. `bounce` lets a particle bounce. `die` ends it. `stop` lets it rest where it hit, without forces, until its life ends; it stays there also if the object moves on. `stick` is the same, but the particle rides an object that moves or turns.
1|part	systems.*.collide.chance=	Chance of the first impact in a step to do what `then` says. Otherwise the particle bounces.
$ kiln complete -- check --set 'systems.*.forces.'
1|part	systems.*.forces.*.	every entry
1|part	systems.*.forces.0.	the first entry
$ kiln complete -- check --set 'systems.*.forces.0.wind.f'
1|part	systems.*.forces.0.wind.field=	Kind of the field.
1|part	systems.*.forces.0.wind.file=	A grid of air velocities. They are interpolated between the points of the grid. Outside of the grid, the air moves as at the nearest edge.
$ kiln complete -- check --set simulation.bounds=
1|word	simulation.bounds=none	
$ kiln complete -- check --set 'systems.*.forces.0.wind.field='
1|word	systems.*.forces.0.wind.field=uniform	
1|word	systems.*.forces.0.wind.field=curl	
1|word	systems.*.forces.0.wind.field=vortex	
1|word	systems.*.forces.0.wind.field=grid	
1|word	systems.*.forces.0.wind.field=baked	
1|word	systems.*.forces.0.wind.field=gas	
$ kiln complete -- check --set post.tonemap=a
1|word	post.tonemap=agx	
1|word	post.tonemap=aces	
$ kiln complete -- check --set backdrop.transparent=
1|word	backdrop.transparent=true	
1|word	backdrop.transparent=false	
$ kiln complete -- check --set post.nothing
$ kiln complete -- figure sheet --sweep ti
1|part	time=	times in seconds
$ kiln complete -- figure sheet --sweep post.tonemap=none,a
1|word	post.tonemap=none,agx	
1|word	post.tonemap=none,aces	
$ kiln complete -- figure sheet --variant 'seed=1;post.tonemap=ac'
1|word	seed=1;post.tonemap=aces	
$ kiln complete -- figure sheet --variant 'seed=1;post.tonem'
1|part	seed=1;post.tonemap=	Tone mapping of light into the colours of the picture.

Nothing follows what makes no sense.

$ kiln complete -- rendre --out
$ kiln complete -- render --outptu=
$ kiln complete -- render --seed ''
$ kiln complete
2|kiln: complete: needs -- WORD...
= 2

Domains of gas of the scene.

$ printf 'kiln: 1\ngas: {fire: {}, plume: {}}\n' >gas.yaml
$ kiln complete -- export gas.yaml --gas=f
1|word	--gas=fire	a domain of gas
$ kiln complete -- export gas.yaml --gas ''
1|word	fire	a domain of gas
1|word	plume	a domain of gas
